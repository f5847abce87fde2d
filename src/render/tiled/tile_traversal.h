// Every pixel adds up what the primitives of its tile's list put there: bodonyi2023 4.4 and 4.5.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/image.h"
#include "contrejour/method_options.h"
#include "ghosts/iris_shape.h"
#include "render/interface/dirt_screen.h"
#include "render/interface/stop_screen.h"
#include "render/tiled/primitive.h"
#include "render/tiled/tile_lists.h"

namespace contrejour::tiled {

// Factor from flux to pixel value, by channel.
using Gain = std::array<float, 3>;

// What all tiles read.
struct TraversalInput {
  const PrimitiveBuffer& buffer;
  std::span<const Gain> gains;  // by Primitive::pass
  const IrisShape& iris;
  std::span<const StopScreen* const> screens;  // by Primitive::pass; null ones, or none at all: the sharp iris
  std::span<const DirtScreen* const> dirt;  // likewise; none at all: the lens is clean
  TiledOptions::Interpolation interpolation = TiledOptions::Interpolation::LoopDeRose;
};

// A tile's pixels in rows, one array a channel, with room behind the end for the widest vector. Kept between tiles;
// one object a thread.
class TilePixels {
 public:
  // Takes the image's values of these pixels, and gives them back.
  void load(const Image& image, const PixelRange& pixels);
  void store(Image& image) const;

  PixelRange pixels;
  std::array<std::vector<float>, 3> value;
  std::vector<float> x, y;  // middles
};

// A pixel takes from every primitive that holds its middle, in the list's order, the irradiance there times the
// gain, unless the interpolated r_rel or stop places say that it is blocked.
void traverse_tile(const TraversalInput& input, std::span<const std::uint32_t> list, TilePixels& tile);

}  // namespace contrejour::tiled
