// SPDX-License-Identifier: Apache-2.0
// The pattern of a polygon as a table of its pixels' transmittances: for whatever a rasteriser has no table of, such as
// several crossings of the stop, half-tones, and dirt that is looked up pixel by pixel.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

// The transmittance at a point of the frame, by channel.
using TransmittanceAt = std::function<std::array<double, 3>(Vec2 pixel)>;

// Adds a table of the pixels that the polygon touches in a frame of this size to the list. samples: across a pixel,
// and down it, of which the mean is taken.
[[nodiscard]] Pattern pixel_pattern(std::span<const Point> polygon, int width, int height, int samples,
                                    const TransmittanceAt& transmittance_at, PolygonList& list);

}  // namespace contrejour::inline internal::adaptive
