// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/band_texture.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "render/polygons/packed_irradiance.h"
#include "render/stop_patterns/resampled.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

using raster::PackedIrradiance;
using raster::TextureTable;

// Samples of a level with their border, interleaved.
struct Grid {
  int side = 0;  // without the border
  std::size_t stride = 1;
  std::vector<float> samples;

  Grid(int samples_a_side, std::size_t floats) : side(samples_a_side), stride(floats) {
    samples.resize(pitch() * pitch() * stride);
  }
  [[nodiscard]] std::size_t pitch() const { return static_cast<std::size_t>(side + 2); }
};

void lay_out(const PatternTexture& texture, double extent, std::size_t part, Grid& grid) {
  const auto samples = resampled({texture.side(), texture.extent(), texture.samples()}, grid.side, extent);
  const auto side = static_cast<std::size_t>(grid.side);
  for (std::size_t row = 0; row < side; ++row) {
    float* to = grid.samples.data() + ((row + 1) * grid.pitch() + 1) * grid.stride + part;
    for (std::size_t column = 0; column < side; ++column, to += grid.stride) *to = samples[row * side + column];
  }
}

Grid halved(const Grid& fine) {
  Grid half(fine.side / 2, fine.stride);
  const std::size_t stride = fine.stride, row = fine.pitch() * stride;
  for (int y = 0; y < half.side; ++y) {
    for (int x = 0; x < half.side; ++x) {
      const float* from = fine.samples.data() + static_cast<std::size_t>(2 * y + 1) * row +
                          static_cast<std::size_t>(2 * x + 1) * stride;
      float* to = half.samples.data() +
                  (static_cast<std::size_t>(y + 1) * half.pitch() + static_cast<std::size_t>(x + 1)) * stride;
      for (std::size_t c = 0; c < stride; ++c)
        to[c] = 0.25F * (from[c] + from[c + stride] + from[c + row] + from[c + row + stride]);
    }
  }
  return half;
}

// Appends the grid's samples as pairs of packed ones, and sets how the level packs them.
void pack(const Grid& grid, std::vector<TextureTable::Pair>& pairs, TextureTable::Level& level) {
  const PackedIrradiance packing(*std::max_element(grid.samples.begin(), grid.samples.end()));
  level.lowest = packing.lowest();
  const std::size_t first = pairs.size(), pitch = grid.pitch();
  pairs.resize(first + grid.samples.size());
  for (std::size_t k = 0; k < grid.samples.size(); ++k) {
    TextureTable::Pair& pair = pairs[first + k];
    pair.here = packing.coded(grid.samples[k]);
    if (k >= pitch) pairs[first + k - pitch].below = pair.here;
  }
}

void append(const Grid& grid, TextureTable& table) {
  TextureTable::Level level{grid.side, 0, 0};
  if (grid.stride == 1) {
    level.first = static_cast<std::uint32_t>(table.pairs.size());
    pack(grid, table.pairs, level);
  } else {
    level.first = static_cast<std::uint32_t>(table.samples.size());
    table.samples.insert(table.samples.end(), grid.samples.begin(), grid.samples.end());
  }
  table.levels.push_back(level);
}

}  // namespace

raster::TextureTable texture_table(std::span<const PatternTexture* const> parts) {
  assert(!parts.empty() && parts.size() <= TextureTable::kWavelengths);
  TextureTable table;
  int side = 0;
  for (const PatternTexture* part : parts) {
    table.extent = std::max(table.extent, part->extent());
    side = std::max(side, part->side());
  }
  Grid grid(side, parts.size() == 1 ? 1 : TextureTable::kStride);
  for (std::size_t k = 0; k < parts.size(); ++k) lay_out(*parts[k], table.extent, k, grid);
  append(grid, table);
  while (grid.side % 2 == 0 && grid.side > 2) {
    grid = halved(grid);
    append(grid, table);
  }
  table.largest_of_last = std::ranges::max(grid.samples);
  return table;
}

BandTexture::BandTexture(raster::TextureTable table, raster::PatternAtlas& atlas)
    : index_(atlas.add(std::move(table))), table_(atlas.texture(index_)) {}

std::uint32_t BandTexture::level_for(double width) const {
  const double level = std::round(DownsampledPicture::level_for(width, table_.levels.front().side, table_.extent));
  return static_cast<std::uint32_t>(std::min(static_cast<std::size_t>(std::max(level, 0.0)), table_.levels.size() - 1));
}

float BandTexture::brightest(Vec2 middle, double distance) const {
  const double pitches = distance * 0.5 * table_.levels.front().side / table_.extent;
  const std::size_t fit = pitches > 1.0 ? static_cast<std::size_t>(std::ilogb(pitches)) + 1 : 0;
  // Four samples of the last level cover less than that distance.
  if (fit >= table_.levels.size()) return table_.largest_of_last;
  const TextureTable::Level& level = table_.levels[fit];
  const auto at = [&](double p) {  // index of the first of the two samples next to p, counting the border
    const double position = (p / table_.extent + 1.0) * 0.5 * level.side + 0.5;
    return position > 0.0 ? static_cast<std::size_t>(std::min(position, level.side + 0.0)) : 0;  // also 0 for NaN
  };
  const std::size_t x = at(middle.x), y = at(-middle.y), pitch = static_cast<std::size_t>(level.pitch());
  if (of_one()) {
    const TextureTable::Pair* const pair = table_.pairs.data() + level.first + y * pitch + x;
    return PackedIrradiance::of_lowest(level.lowest)
        .light(std::max({pair[0].here, pair[0].below, pair[1].here, pair[1].below}));
  }
  constexpr std::size_t kStride = TextureTable::kStride;
  const auto largest = [&](const float* two) { return *std::max_element(two, two + 2 * kStride); };
  const float* const samples = table_.samples.data() + level.first + (y * pitch + x) * kStride;
  return std::max(largest(samples), largest(samples + pitch * kStride));
}

}  // namespace contrejour::inline internal::stop_patterns
