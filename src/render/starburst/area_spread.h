// Images of lights with a size as diffraction and scatter spread them: a point's, blurred by the light's own image
// (docs/physics/area-lights.md). Nothing is ever subtracted: where a point's spread has no negative light, neither has
// the sum.
#pragma once

#include <functional>
#include <span>

#include "contrejour/render.h"
#include "render/starburst/light_groups.h"

namespace contrejour {

// What a point of light at a light's direction spreads over pixels of a pitch, from its image outwards.
struct PointSpread {
  double pixel_pitch_mm = 0.0;
  double radius_px = 0.0;  // as far as it is asked for
};

// Adds the spread of the light's point, of this flux, to an image; the centre in pixels of that image.
using AddPointSpread = std::function<Result<void>(Image& image, std::size_t light, const PointSpread& spread,
                                                  Vec2 centre_px, const Rgb& flux)>;

// Near a light's image in as many pixels as its outline needs, farther out in as few as the blur allows; from the one
// to the other they fade. Errors: those of `add_point`, Cancelled.
[[nodiscard]] Result<void> add_area_spread(Image& image, std::span<const ImagedLight> areas, const LensState& lens,
                                           std::span<const Light> lights, const Frame& frame,
                                           const AddPointSpread& add_point, const Context& context);

}  // namespace contrejour
