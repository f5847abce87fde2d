// SPDX-License-Identifier: Apache-2.0
// A table of the irradiance behind a long straight edge: 0 in the dark, 1 far inside the light, with fringes between,
// of which the first reaches 1.370 (Born & Wolf 8.7.3). Positions are t = d sqrt(2 F), with d the distance into the
// light in stop radii. A band of wavelengths is averaged, which leaves the first fringes and blurs the others.
//
// Accuracy: 1e-4 where the fringes of one wavelength are not tapered, which begins at t = 24; the light within the
// table's ends equals the total. Thread-safety: constant after construction.
#pragma once

#include <vector>

namespace contrejour::inline internal::stop_patterns {

class EdgeProfile {
 public:
  static constexpr double kDarkBelow = -6.0;  // 0.14 per cent at one edge, tapered off
  static constexpr double kLevelAbove = 32.0;

  // spread: RMS deviation of a band's wavelengths from their mean, over the mean; 0: one wavelength.
  explicit EdgeProfile(double spread);

  // The mean over `width` about t; width may be 0.
  [[nodiscard]] double at(double t, double width) const;

  // The position beyond which the profile differs from 1 by less than the tolerance.
  [[nodiscard]] double level_above(double tolerance) const;

  // Between `dark` and `level` lies all of the profile except fringes weaker than `ripple`.
  struct Range {
    double dark = kDarkBelow, level = kLevelAbove;
  };
  [[nodiscard]] Range range_above(double ripple) const;
  // The squared error of truncating the profile there, integrated over t.
  [[nodiscard]] double squared_error(Range range) const;

 private:
  std::vector<double> value_;  // by steps from kDarkBelow on
  std::vector<double> integral_;  // from kDarkBelow to each step
  std::vector<double> worst_from_;  // largest difference from 1 from each step on
  std::vector<double> brightest_to_;  // largest value up to each step
  std::vector<double> error_to_, error_from_;  // squared error left out before and from a step
};

}  // namespace contrejour::inline internal::stop_patterns
