// SPDX-License-Identifier: Apache-2.0
// The reflectance of a coated surface, for plots, and other coatings for single surfaces of a document as its
// --coating-at values. Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "contrejour/expert/colour.h"
#include "studio/core/document.h"

namespace contrejour::studio {

inline constexpr std::array<double, 3> kCurveAngles_deg = {0, 20, 40};  // of incidence, in air where there is air
inline constexpr std::size_t kCurvePoints = 96;
inline constexpr double kFirstCurve_nm = 380, kLastCurve_nm = 740;

struct ReflectanceCurves {
  std::array<std::array<double, kCurvePoints>, 3> reflectance{};  // by angle, then wavelength
  double largest = 0;
};
[[nodiscard]] ReflectanceCurves reflectance_curves(const SurfaceState& surface);

// At normal incidence: the reflectance of daylight (D65) as the eye weighs its wavelengths, and the colour of the
// reflection of white light.
[[nodiscard]] double luminous_reflectance(const SurfaceState& surface);
[[nodiscard]] Rgb reflected_rgb(const SurfaceState& surface);

// The coating that the document's values give this surface (1-based), or else the lens's own, as text.
[[nodiscard]] std::string coating_of_surface(const Document& document, int surface);
// The coating that the lens's file gives this surface, as text. It may be a name of the file's, which no value can be.
[[nodiscard]] std::string own_coating(const Document& document, int surface);
[[nodiscard]] bool is_only_a_name(const std::string& coating);
// The name of the lens's own coating takes away the one in its place. Errors: also the name of a measured coating while
// the document's `coating` replaces those of all surfaces.
[[nodiscard]] Result<Document> with_surface_coating(Document document, int surface, const std::string& coating);

// The wavelength that a design is made for; none where the coating has no such number.
[[nodiscard]] std::optional<double> design_wavelength_nm(const Document& document, int surface);
// The same design for another wavelength: "v-coat:480" of "v-coat".
[[nodiscard]] std::string with_design_wavelength(const std::string& coating, double lambda_nm);

}  // namespace contrejour::studio
