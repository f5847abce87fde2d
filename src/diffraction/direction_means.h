// What varies with direction and is the same in opposite ones, as power spectra of real masks are: its means over
// windows of directions, from values in equal parts of half a turn.
#pragma once

#include <span>
#include <vector>

namespace contrejour {

class DirectionMeans {
 public:
  DirectionMeans() = default;
  explicit DirectionMeans(std::span<const double> values);  // the first part begins at angle 0

  // Windows narrower than a part are taken as wide: values go over into each other by straight lines.
  [[nodiscard]] double over(double angle_rad, double window_rad) const;

 private:
  [[nodiscard]] double until(double parts) const;

  std::vector<double> below_;  // sums of the values before each part, and of all
};

}  // namespace contrejour
