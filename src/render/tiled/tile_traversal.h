// SPDX-License-Identifier: Apache-2.0
// Each pixel sums the light of the primitives in its tile's list: bodonyi2023 4.4 and 4.5.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/image.h"
#include "contrejour/method_options.h"
#include "ghosts/iris_shape.h"
#include "render/stop_patterns/stop_transmittance.h"
#include "render/tiled/primitive.h"
#include "render/tiled/tile_lists.h"

namespace contrejour::inline internal::tiled {

// Factor from flux to pixel value, by channel.
using Gain = std::array<float, 3>;

// The input that all tiles share.
struct TraversalInput {
  const PrimitiveBuffer& buffer;
  std::span<const Gain> gains;  // by Primitive::pass
  const IrisShape& iris;
  std::span<const StopTransmittance> stops;  // by Primitive::pass; empty: the iris is sharp and the lens clean
  TiledOptions::Interpolation interpolation = TiledOptions::Interpolation::LoopDeRose;
};

// A tile's pixels in rows, one array for each channel, with padding at the end for the widest vector. Kept between
// tiles; one object for each thread.
class TilePixels {
 public:
  // Loads the image's values of these pixels, and stores them again.
  void load(const Image& image, const PixelRange& pixels);
  void store(Image& image) const;

  PixelRange pixels;
  std::array<std::vector<float>, 3> value;
  std::vector<float> x, y;  // middles
};

// Each pixel adds, for every primitive of the list that contains its middle, in order, the irradiance there times the
// gain, unless the interpolated relative_height or stop points show that the light is blocked.
void traverse_tile(const TraversalInput& input, std::span<const std::uint32_t> list, TilePixels& tile);

}  // namespace contrejour::inline internal::tiled
