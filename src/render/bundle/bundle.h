#pragma once

#include "render/interface/method.h"

namespace contrejour {

// hullin2011: a uniform grid of rays per ghost, light and wavelength, its cells rasterised with interpolated
// aperture coordinates and clipping, ghost by ghost.
[[nodiscard]] Result<DrawnFlare> render_bundle(const PlannedFrame& planned, const BundleOptions& options,
                                               const Context& context);

inline constexpr Method kBundle = method_of<BundleOptions, render_bundle>({});

}  // namespace contrejour
