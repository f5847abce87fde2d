// SPDX-License-Identifier: Apache-2.0
// The half-tones of a picture as the iris: the transmittance of each point of the stop.
// Units: stop radii. Thread-safety: constant after it is made. Source: hullin2011 3.2, real-valued transmission.
#pragma once

#include <vector>

#include "aperture/iris_samples.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

// True if a picture has transmittances between dark and bright that are not smoothed edges: pixels without both a dark
// and a bright neighbour.
[[nodiscard]] bool contains_half_tones(std::span<const float> level, int width, int height, float highest);

class HalfTones {
 public:
  // Levels below this fraction of the highest are dark.
  static constexpr float kDark = 1.0F / 256.0F;

  HalfTones(const StopSamples& samples, float highest);

  // The mean over an upright square about p. The picture is constant within each sample, so a square one sample wide
  // gives bilinear interpolation, which is also used for smaller ones. Points beyond the picture do not count.
  [[nodiscard]] double mean(Vec2 p, double width) const;
  [[nodiscard]] double flux() const { return flux_; }  // integral over the rim's circle

 private:
  [[nodiscard]] double sum_to(double column, double row) const;

  int side_;
  std::vector<double> sums_;  // of all samples below and to the left of each corner of samples
  double flux_ = 0.0;
};

}  // namespace contrejour::inline internal
