// The picture that tiles are drawn into.
#pragma once

#include "contrejour/image.h"
#include "image/pixel_writer.h"
#include "render/adaptive/tiles/tile_sums.h"
#include "render/adaptive/tiles/tiles.h"

namespace contrejour::adaptive {

struct TileCanvas {
  Image& image;
  int top = 0;  // the frame's row that it begins with
  TileMode mode = TileMode::Write;
  PixelWriter writer;

  [[nodiscard]] float* at(const TileSums& tile, int row) const {
    return image.pixels.data() + image.index(tile.x0, tile.y0 + row - top);
  }
};

}  // namespace contrejour::adaptive
