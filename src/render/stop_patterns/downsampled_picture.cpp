// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/downsampled_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::stop_patterns {

DownsampledPicture::DownsampledPicture(int side, double extent, std::vector<float> samples) : extent_(extent) {
  levels_.push_back({side, std::move(samples)});
  while (levels_.back().side % 2 == 0 && levels_.back().side > 2) {
    const Level& fine = levels_.back();
    Level half{fine.side / 2, {}};
    const auto at = [&](int x, int y) { return fine.samples[static_cast<std::size_t>(y * fine.side + x)]; };
    for (int y = 0; y < half.side; ++y)
      for (int x = 0; x < half.side; ++x)
        half.samples.push_back(
            0.25F * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1)));
    levels_.push_back(std::move(half));
  }
}

double DownsampledPicture::bilinear(const Level& level, Vec2 p) const {
  const double scale = 0.5 * level.side / extent_;
  const double x = (p.x + extent_) * scale - 0.5, y = (extent_ - p.y) * scale - 0.5;
  if (!(x > -1.0 && y > -1.0 && x < level.side && y < level.side)) return 0.0;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const double s = x - x0, t = y - y0;
  const auto sample = [&](int column, int row) {
    const bool inside = column >= 0 && row >= 0 && column < level.side && row < level.side;
    return inside ? static_cast<double>(level.samples[static_cast<std::size_t>(row * level.side + column)]) : 0.0;
  };
  return (1.0 - t) * ((1.0 - s) * sample(x0, y0) + s * sample(x0 + 1, y0)) +
         t * ((1.0 - s) * sample(x0, y0 + 1) + s * sample(x0 + 1, y0 + 1));
}

// Bilinear interpolation of samples that are w wide blurs by w / 2, root mean square; a square blurs by its width over
// the root of 12.
double DownsampledPicture::level_for(double width, int side, double extent) {
  const double samples = width / std::numbers::sqrt3 * 0.5 * side / extent;
  return samples > 1.0 ? std::log2(samples) : 0.0;
}

// Interpolates between two levels.
double DownsampledPicture::at(Vec2 p, double width) const {
  const double level = std::min(level_for(width, side(), extent_), static_cast<double>(levels_.size() - 1));
  const auto fine = std::min(static_cast<std::size_t>(level), levels_.size() - 1);
  const double remainder = level - static_cast<double>(fine);
  const double value = bilinear(levels_[fine], p);
  return remainder > 0.0 && fine + 1 < levels_.size() ? std::lerp(value, bilinear(levels_[fine + 1], p), remainder)
                                                      : value;
}

}  // namespace contrejour::inline internal::stop_patterns
