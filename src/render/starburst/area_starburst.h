// Starbursts of lights with a size: the point's, blurred by the light's own image (docs/physics/area-lights.md).
#pragma once

#include <functional>
#include <span>

#include "contrejour/render.h"
#include "contrejour/starburst.h"
#include "render/starburst/light_groups.h"

namespace contrejour {

// A light's starburst for pixels of this pitch, drawn so far from its centre.
using MakeStarburst = std::function<Result<Starburst>(std::size_t light, double pixel_pitch_mm, double radius_px)>;

// Near a light's image in as many pixels as its outline needs, farther out in as few as the blur allows; from the one
// to the other they fade. Errors: those of `make`, Cancelled.
[[nodiscard]] Result<void> add_area_starbursts(Image& image, std::span<const ImagedLight> areas, const LensState& lens,
                                               std::span<const Light> lights, const RenderSettings& settings,
                                               const MakeStarburst& make, const Context& context);

}  // namespace contrejour
