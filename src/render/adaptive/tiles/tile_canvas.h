// SPDX-License-Identifier: Apache-2.0
// The image that tiles are drawn into.
#pragma once

#include <algorithm>
#include <cstddef>

#include "contrejour/image.h"
#include "image/pixel_writer.h"
#include "render/adaptive/tiles/tile_sums.h"
#include "render/adaptive/tiles/tiles.h"

namespace contrejour::inline internal::adaptive {

// An image of a frame, or of the part of it that begins at (left, top).
struct TileCanvas {
  Image& image;
  int left = 0, top = 0;
  RasterMode mode = RasterMode::Write;
  PixelWriter writer;

  TileCanvas(const RasterTarget& target, RasterMode how)
      : image(target.image), left(target.left), top(target.top), mode(how), writer(target.image) {}

  // The pixels of a row of a tile that lies within the image.
  [[nodiscard]] float* at(const TileSums& tile, int row) const {
    return image.pixels.data() + image.index(tile.x0 - left, tile.y0 + row - top);
  }
  // Sets a tile's pixels to zero, as far as they lie within the image.
  void clear(const TileSums& tile) const {
    const int x0 = std::max(tile.x0 - left, 0), x1 = std::min(tile.x0 + tile.width - left, image.width);
    const int y0 = std::max(tile.y0 - top, 0), y1 = std::min(tile.y0 + tile.height - top, image.height);
    for (int y = y0; y < y1 && x0 < x1; ++y)
      writer.clear(TileSums::kPixel * static_cast<std::size_t>(x1 - x0), image.pixels.data() + image.index(x0, y));
  }
};

}  // namespace contrejour::inline internal::adaptive
