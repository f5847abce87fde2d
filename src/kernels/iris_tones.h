// The half-tones of a picture as the iris: what share of the light each place of the stop lets through.
// Units: stop radii. Thread-safety: constant after it is made. Source: hullin2011 3.2, real-valued transmission.
#pragma once

#include <vector>

#include "contrejour/vec.h"
#include "kernels/iris_samples.h"

namespace contrejour {

// Whether a picture has transmittances between dark and bright that are not one of its edges, drawn smoothly: pixels
// that have no dark and bright pixel beside them.
[[nodiscard]] bool has_half_tones(std::span<const float> level, int width, int height, float highest);

class IrisTones {
 public:
  // Levels below this share of the highest are dark.
  static constexpr float kDark = 1.0F / 256.0F;

  IrisTones(const StopSamples& samples, float highest);

  // The mean over an upright square about p. The picture is even within each sample, so a square one sample wide is
  // bilinear interpolation, and no smaller one is asked about. What lies beyond the picture does not count.
  [[nodiscard]] double mean(Vec2 p, double width) const;
  [[nodiscard]] double flux() const { return flux_; }  // integral over the rim's circle

 private:
  [[nodiscard]] double sum_to(double column, double row) const;

  int side_;
  std::vector<double> sums_;  // of all samples below and to the left of each corner of samples
  double flux_ = 0.0;
};

}  // namespace contrejour
