// SPDX-License-Identifier: Apache-2.0
// A square picture for look-ups of the mean over a square about any point: an image pyramid.
// Units: the caller's, for positions; 0 outside. Thread-safety: constant after construction.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::stop_patterns {

class DownsampledPicture {
 public:
  // samples: side x side over the square from -extent to extent, rows from the top. side: a multiple of 16 or so, since
  // it is halved that often.
  DownsampledPicture(int side, double extent, std::vector<float> samples);

  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] int side() const { return levels_.front().side; }
  [[nodiscard]] std::span<const float> samples() const { return levels_.front().samples; }
  // How often samples must be halved for bilinear interpolation to give the mean over a width; at least 0.
  [[nodiscard]] static double level_for(double width, int side, double extent);
  [[nodiscard]] double at(Vec2 p, double width) const;
  [[nodiscard]] std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Level& level : levels_) sum += level.samples.size() * sizeof(float);
    return sum;
  }

 private:
  struct Level {
    int side = 0;
    std::vector<float> samples;
  };
  [[nodiscard]] double bilinear(const Level& level, Vec2 p) const;

  double extent_;
  std::vector<Level> levels_;
};

}  // namespace contrejour::inline internal::stop_patterns
