// Where light that falls on the samples of an exit pupil's mask crosses another plane.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/pupil_mask.h"
#include "contrejour/vec.h"
#include "render/starburst/smooth_fit.h"

namespace contrejour {

// Both coordinates of places that belong to others.
[[nodiscard]] SmoothFit fit_places(std::span<const Vec2> from, std::span<const Vec2> to, int degree);

class MaskPlaces {
 public:
  // From rays' direction cosines and the places at which they cross the plane, by polynomials of a degree; middle: the
  // cosines of the mask's middle. Outside the rays' cosines, where polynomials hold nothing, the nearest place within.
  MaskPlaces(std::span<const Vec2> cosines, std::span<const Vec2> places, int degree, Vec2 middle,
             const MaskGrid& grid);

  // In samples from the first one's middle, by straight lines between knots: off by 1e-4 of the pupil at most.
  [[nodiscard]] Vec2 at(double column, double row) const;
  [[nodiscard]] double sample() const;  // how far apart the samples' places are

 private:
  static constexpr int kKnotStep = 8;  // samples

  int knots_;  // a side
  std::vector<Vec2> at_knot_;
};

}  // namespace contrejour
