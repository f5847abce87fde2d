// SPDX-License-Identifier: Apache-2.0
// Means over windows of directions of a function that is equal in opposite directions, as power spectra of real masks
// are, given by its values in equal parts of half a turn.
#pragma once

#include <span>
#include <vector>

namespace contrejour::inline internal {

class DirectionMeans {
 public:
  DirectionMeans() = default;
  explicit DirectionMeans(std::span<const double> values);  // the first part begins at angle 0

  // Windows narrower than a part count as one part wide, which interpolates linearly between values.
  [[nodiscard]] double over(double angle_rad, double window_rad) const;

 private:
  [[nodiscard]] double until(double parts) const;

  std::vector<double> below_;  // cumulative sums of the values
};

}  // namespace contrejour::inline internal
