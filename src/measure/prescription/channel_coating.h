// SPDX-License-Identifier: Apache-2.0
// Reflectances of a surface in the three channels of a light, and a coating that has them.
// Thread-safety: pure functions.
#pragma once

#include <optional>
#include <span>

#include "contrejour/expert/colour.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Mean reflectances at normal incidence, weighted as the channels weight the light's spectrum.
[[nodiscard]] Rgb channel_reflectance(const SurfaceState& surface, std::span<const SpectralBand> bands);

// A tabulated coating (MeasuredCoating) with these means: the single film that has nearly the same ones, whose
// reflectance at each angle of incidence is Fresnel's, and a parabola of the phase in a film for what remains, as of
// coatings of several films. The numbers are rounded to a file's precision.
[[nodiscard]] Coating channel_coating(const SurfaceState& surface, const Rgb& wanted,
                                      std::span<const SpectralBand> bands);

}  // namespace contrejour::inline internal
