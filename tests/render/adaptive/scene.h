// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of this folder: drawing of polygons.
#pragma once

#include <algorithm>
#include <limits>

#include <doctest/doctest.h>

#include "render/adaptive/tiles/tiles.h"
#include "render/ray_maps/ghost_scene.h"
#include "support/scenes.h"
#include "support/sum_of_channel.h"

namespace contrejour::test {

// Draws lists of polygons in order.
inline Image drawn(std::span<const adaptive::PolygonList> lists, int width, int height,
                   const adaptive::PatternAtlas* atlas = nullptr) {
  adaptive::TileRasteriser rasteriser;
  const auto batch = rasteriser.new_batch(width, height, atlas);
  batch->extend(lists.size());
  for (std::size_t k = 0; k < lists.size(); ++k) batch->set(k, lists[k]);
  Image image = Image::unwritten(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::numeric_limits<float>::quiet_NaN());  // all get written
  batch->draw(adaptive::RasterMode::Write, {.threads = 1}, {image});
  return image;
}

inline Image drawn(const adaptive::PolygonList& list, int width, int height,
                   const adaptive::PatternAtlas* atlas = nullptr) {
  return drawn({&list, 1}, width, height, atlas);
}

// Positive where the corners turn from +x to +y.
inline double signed_area(std::span<const adaptive::Point> polygon) {
  double twice = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const adaptive::Point a = polygon[k];
    const adaptive::Point b = polygon[(k + 1) % polygon.size()];
    twice += static_cast<double>(a.x) * b.y - static_cast<double>(b.x) * a.y;
  }
  return 0.5 * twice;
}

}  // namespace contrejour::test
