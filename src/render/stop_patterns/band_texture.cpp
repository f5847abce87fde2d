// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/band_texture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "render/stop_patterns/resampled.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

void lay_out(const PatternTexture& texture, double extent, std::size_t part, std::size_t stride,
             BandTexture::Level& level) {
  const auto samples = resampled({texture.side(), texture.extent(), texture.samples()}, level.side, extent);
  const auto side = static_cast<std::size_t>(level.side);
  for (std::size_t row = 0; row < side; ++row) {
    float* to = level.samples.data() + ((row + 1) * static_cast<std::size_t>(level.pitch()) + 1) * stride + part;
    for (std::size_t column = 0; column < side; ++column, to += stride) *to = samples[row * side + column];
  }
}

BandTexture::Level dark_level(int side, std::size_t stride) {
  BandTexture::Level level;
  level.side = side;
  level.samples.resize(static_cast<std::size_t>(level.pitch()) * static_cast<std::size_t>(level.pitch()) * stride);
  return level;
}

BandTexture::Level halved(const BandTexture::Level& fine, std::size_t stride) {
  BandTexture::Level half = dark_level(fine.side / 2, stride);
  const auto row = static_cast<std::size_t>(fine.pitch()) * stride;
  for (int y = 0; y < half.side; ++y) {
    for (int x = 0; x < half.side; ++x) {
      const float* from = fine.samples.data() + static_cast<std::size_t>(2 * y + 1) * row +
                          static_cast<std::size_t>(2 * x + 1) * stride;
      float* to = half.samples.data() + static_cast<std::size_t>((y + 1) * half.pitch() + x + 1) * stride;
      for (std::size_t c = 0; c < stride; ++c)
        to[c] = 0.25F * (from[c] + from[c + stride] + from[c + row] + from[c + row + stride]);
    }
  }
  return half;
}

void code(BandTexture::Level& level) {
  level.coding = ShortLight(*std::max_element(level.samples.begin(), level.samples.end()));
  level.coded.resize(level.samples.size());
  const auto pitch = static_cast<std::size_t>(level.pitch());
  for (std::size_t k = 0; k < level.samples.size(); ++k) {
    level.coded[k].here = level.coding.coded(level.samples[k]);
    if (k >= pitch) level.coded[k - pitch].below = level.coded[k].here;
  }
  level.samples = {};
}

}  // namespace

BandTexture::BandTexture(std::span<const PatternTexture* const> parts) : stride_(parts.size() == 1 ? 1 : kStride) {
  assert(!parts.empty() && parts.size() <= kMost);
  int side = 0;
  for (const PatternTexture* part : parts) {
    extent_ = std::max(extent_, part->extent());
    side = std::max(side, part->side());
  }
  levels_.push_back(dark_level(side, stride_));
  for (std::size_t k = 0; k < parts.size(); ++k) lay_out(*parts[k], extent_, k, stride_, levels_.back());
  while (levels_.back().side % 2 == 0 && levels_.back().side > 2) levels_.push_back(halved(levels_.back(), stride_));
  brightest_of_last_ = std::ranges::max(levels_.back().samples);
  if (of_one())
    for (Level& level : levels_) code(level);
}

const BandTexture::Level& BandTexture::level_for(double width) const {
  const double level = std::round(HalvedPicture::level_for(width, levels_.front().side, extent_));
  return levels_[std::min(static_cast<std::size_t>(std::max(level, 0.0)), levels_.size() - 1)];
}

float BandTexture::brightest(Vec2 middle, double distance) const {
  const double pitches = distance * 0.5 * levels_.front().side / extent_;
  const std::size_t fit = pitches > 1.0 ? static_cast<std::size_t>(std::ilogb(pitches)) + 1 : 0;
  if (fit >= levels_.size()) return brightest_of_last_;  // four samples of the last level cover less than that distance
  const Level& level = levels_[fit];
  const auto at = [&](double p) {  // index of the first of the two samples next to p, counting the border
    const double place = (p / extent_ + 1.0) * 0.5 * level.side + 0.5;
    return place > 0.0 ? static_cast<int>(std::min(place, level.side + 0.0)) : 0;  // also 0 for NaN
  };
  const int x = at(middle.x), y = at(-middle.y);
  const std::size_t from = static_cast<std::size_t>(y * level.pitch() + x) * stride_;
  if (of_one()) {
    const Level::Pair left = level.coded[from], right = level.coded[from + 1];
    return level.coding.light(std::max({left.here, left.below, right.here, right.below}));
  }
  const auto largest = [&](const float* two) { return *std::max_element(two, two + 2 * stride_); };
  const float* const samples = level.samples.data() + from;
  return std::max(largest(samples), largest(samples + static_cast<std::size_t>(level.pitch()) * stride_));
}

}  // namespace contrejour::inline internal::stop_patterns
