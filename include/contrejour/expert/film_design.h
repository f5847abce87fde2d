// SPDX-License-Identifier: Apache-2.0
// Refines the thicknesses of a film stack towards a goal by the Levenberg-Marquardt method, for fixed materials and
// light at normal incidence from air. The optimum is local: another start may lead to another one. Thread-safety: pure
// functions.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/coating.h"
#include "contrejour/export.h"

namespace contrejour {

// Designs by name: "v-coat", "w-coat", "quarter-half-quarter", "broadband-4" to "broadband-7".
[[nodiscard]] CONTREJOUR_API std::vector<std::string> coating_design_names();
[[nodiscard]] CONTREJOUR_API std::optional<DesignedCoating> find_coating_design(std::string_view name);
[[nodiscard]] CONTREJOUR_API std::string design_name(const DesignedCoating& design);

// Reflectance of a stack on a glass, at each wavelength.
[[nodiscard]] CONTREJOUR_API std::vector<double> reflectances(const FilmStack& stack, const Glass& glass,
                                                              std::span<const double> lambda_nm);

struct FilmGoal {
  std::vector<double> lambda_nm;
  // Residuals of the reflectances at those wavelengths, whose sum of squares is minimised. Every call returns the same
  // number of residuals.
  std::function<std::vector<double>(std::span<const double> reflectance)> off;
};

// Thicknesses stay within 0 and kThickestFilm_nm.
inline constexpr double kThickestFilm_nm = 1000.0;
[[nodiscard]] CONTREJOUR_API FilmStack refined(const FilmStack& start, const Glass& glass, const FilmGoal& goal);

}  // namespace contrejour
