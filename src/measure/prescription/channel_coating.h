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

// A tabulated coating (MeasuredCoating) with these means: a parabola of the phase in a film. With the angle of
// incidence it shifts to shorter wavelengths, as films do, and rises as the bare glass does. The numbers are rounded to
// a file's precision.
[[nodiscard]] Coating channel_coating(const SurfaceState& surface, const Rgb& reflectance,
                                      std::span<const SpectralBand> bands);

}  // namespace contrejour::inline internal
