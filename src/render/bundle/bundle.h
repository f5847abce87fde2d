// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/planning/method.h"

namespace contrejour::inline internal {

// hullin2011: a uniform grid of rays for each ghost, light and wavelength; its cells are rasterised with interpolated
// aperture coordinates and clipped, ghost by ghost.
[[nodiscard]] Result<DrawnFlare> render_bundle(const PlannedFrame& planned, const BundleOptions& options,
                                               const Context& context);

inline constexpr Method kBundle = method_of<BundleOptions, render_bundle>({});

}  // namespace contrejour::inline internal
