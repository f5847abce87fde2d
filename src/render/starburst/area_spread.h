// SPDX-License-Identifier: Apache-2.0
// The images of extended lights as diffraction and scattering spread them: a point's spread, blurred by the light's own
// image (docs/physics/area-lights.md). Nothing is ever subtracted: if a point's spread has no negative light, the sum
// has none.
#pragma once

#include <functional>
#include <span>

#include "contrejour/render.h"
#include "render/starburst/light_groups.h"

namespace contrejour::inline internal {

// What a point spread is needed for: pixels of some pitch, out to a radius from the point's image.
struct PointSpread {
  double pixel_pitch_mm = 0.0;
  double radius_px = 0.0;  // how far it is needed
};

// Adds the spread of a point in the light's direction, with this flux, to an image; the centre is in pixels of that
// image.
using AddPointSpread = std::function<Result<void>(Image& image, std::size_t light, const PointSpread& spread,
                                                  Vec2 centre_px, const Rgb& flux)>;

// Near a light's image the pixels are as fine as its outline needs; farther out they are as coarse as the blur allows,
// with a smooth transition. area_count: the lights of all images of the frame, which share the work that it may take.
// Errors: those of `add_point`, Cancelled.
[[nodiscard]] Result<void> add_area_spread(Image& image, std::span<const ImagedLight> areas, std::size_t area_count,
                                           const LensState& lens, std::span<const Light> lights, const Frame& frame,
                                           const AddPointSpread& add_point, const Context& context);

}  // namespace contrejour::inline internal
