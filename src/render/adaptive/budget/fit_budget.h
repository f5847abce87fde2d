// SPDX-License-Identifier: Apache-2.0
// Limits by which polynomial fits to boxes of the pupil are accepted, refined or given up.
#pragma once

#include "render/adaptive/budget/tolerance.h"
#include "render/ray_maps/first_rays.h"

namespace contrejour::inline internal::adaptive {

inline constexpr int kMinNodes = 5;  // of a fit, along a side of its box
// Single precision places a ray on the sensor to within 1e-3 mm; the box in the entrance plane must not be too small
// for it.
inline constexpr double kFloatError_mm = 1e-3;
inline constexpr double kFloatBox_mm = 0.05;
inline constexpr double kWorthShrinking =
    0.5;  // of a box's area: if its illuminated region has no more, the box is reduced to it
// For light behind a stop pattern: the largest factor by which tolerances of dim light grow, and the multiple of the
// negligible level below which any fit will do.
inline constexpr double kMaxLoosening = 64.0, kNegligibleLevels = 10.0;
inline constexpr int kNextToFailure =
    1;  // further quarterings where too much light would be lost next to rays that fail
// Light that linear interpolation beside failing rays misplaces by more than this multiple of the positions' tolerance
// counts as lost. Otherwise caustics next to such rays are drawn as bundles of streaks at any error (Heliar 1-9 at
// f/3.5). A smaller multiple makes frames of the Planar wide open slower and no picture better.
inline constexpr double kMisplaced = 16.0;
inline constexpr double kHopeless = 2.0;  // times the tolerance, predicted for more nodes: the box is then quartered

// The first rays through a box, at kMinNodes, with the tolerance that the budget allows.
[[nodiscard]] FirstRays first_rays_within(const ErrorBudget& budget, GhostTracers& tracers,
                                          const WavelengthSamples& samples, const Rectangle& box, const Frame& frame);

}  // namespace contrejour::inline internal::adaptive
