// SPDX-License-Identifier: Apache-2.0
// The rules that readers share with validate(), so that an error can name the line of the value itself.
#pragma once

#include <optional>
#include <string>

#include "contrejour/expert/coating.h"
#include "contrejour/expert/glass.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

inline constexpr int kMaxSurfaces = 200;
inline constexpr int kMaxZoomPositions = 200;
inline constexpr int kMaxFilmLayers = 200;
inline constexpr std::size_t kMaxMeasured = 1000;  // wavelengths, or angles, of a measured coating

// The problem and its remedy, or nothing. The index of a glass must be within its limits over the visible.
[[nodiscard]] std::optional<std::string> glass_problem(const Glass& glass);
[[nodiscard]] std::optional<std::string> coating_problem(const Coating& coating);
[[nodiscard]] std::optional<std::string> shape_problem(const Surface& surface);
[[nodiscard]] std::optional<std::string> aperture_problem(const Surface& surface);
[[nodiscard]] std::optional<std::string> obscuration_problem(const Surface& surface);

}  // namespace contrejour::inline internal
