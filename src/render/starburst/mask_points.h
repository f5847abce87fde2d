// SPDX-License-Identifier: Apache-2.0
// The points in another plane that light at the samples of an exit pupil's mask crosses.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/expert/pupil_mask.h"
#include "contrejour/expert/vec.h"
#include "render/starburst/smooth_fit.h"

namespace contrejour::inline internal {

// A fit of both coordinates of one set of points as functions of another set.
[[nodiscard]] SmoothFit fit_points(std::span<const Vec2> from, std::span<const Vec2> to, int degree);

class MaskPoints {
 public:
  // Fits polynomials of a degree from rays' direction cosines to the points at which they cross the plane; middle: the
  // cosines of the mask's middle. Outside the rays' cosines, where the polynomials are not valid, the nearest point
  // inside is used.
  MaskPoints(std::span<const Vec2> cosines, std::span<const Vec2> points, int degree, Vec2 middle,
             const MaskGrid& grid);

  // Coordinates in samples from the middle of the first one. Linear interpolation between knots: the error is at most
  // 1e-4 of the pupil.
  [[nodiscard]] Vec2 at(double column, double row) const;
  [[nodiscard]] double sample() const;  // distance between the points of neighbouring samples

 private:
  static constexpr int kKnotStep = 8;  // samples

  int knots_;  // a side
  std::vector<Vec2> at_knot_;
};

}  // namespace contrejour::inline internal
