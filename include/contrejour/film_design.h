// Stacks of films towards a goal: thicknesses refined by Levenberg and Marquardt's method from a start, materials as
// they are. Light at normal incidence from air. Local: another start may end elsewhere. Thread-safety: pure functions.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/coating.h"

namespace contrejour {

// Designs by name: "v-coat", "w-coat", "quarter-half-quarter", "broadband-4" to "broadband-7".
[[nodiscard]] std::vector<std::string> coating_design_names();
[[nodiscard]] std::optional<DesignedCoating> find_coating_design(std::string_view name);
[[nodiscard]] std::string design_name(const DesignedCoating& design);

// Of a stack on a glass, at each wavelength.
[[nodiscard]] std::vector<double> reflectances(const FilmStack& stack, const Glass& glass,
                                               std::span<const double> lambda_nm);

struct FilmGoal {
  std::vector<double> lambda_nm;
  // What is off, of reflectances at those wavelengths: its squares' sum is made small. Always as many as the first
  // time.
  std::function<std::vector<double>(std::span<const double> reflectance)> off;
};

// Thicknesses stay within 0 and kThickestFilm_nm.
inline constexpr double kThickestFilm_nm = 1000.0;
[[nodiscard]] FilmStack refined(const FilmStack& start, const Glass& glass, const FilmGoal& goal);

}  // namespace contrejour
