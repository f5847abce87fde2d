// SPDX-License-Identifier: Apache-2.0
#include "diffraction/direction_means.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal {

DirectionMeans::DirectionMeans(std::span<const double> values) : below_{0.0} {
  for (const double value : values) below_.push_back(below_.back() + value);
}

// The integral from angle 0 to an angle in parts.
double DirectionMeans::until(double parts) const {
  const double count = static_cast<double>(below_.size()) - 1.0;
  const double half_turns = std::floor(parts / count);
  const double position = std::clamp(parts - half_turns * count, 0.0, count);
  const auto i = std::min(static_cast<std::size_t>(position), below_.size() - 2);
  const double t = position - static_cast<double>(i);
  return half_turns * below_.back() + (1.0 - t) * below_[i] + t * below_[i + 1];
}

double DirectionMeans::over(double angle_rad, double window_rad) const {
  if (below_.size() < 2) return 0.0;
  const double per_rad = (static_cast<double>(below_.size()) - 1.0) / std::numbers::pi;
  const double width = std::max(1.0, window_rad * per_rad);
  const double first = angle_rad * per_rad - 0.5 * width;
  return (until(first + width) - until(first)) / width;
}

}  // namespace contrejour::inline internal
