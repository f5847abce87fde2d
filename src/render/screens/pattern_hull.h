// Lines around what is worth drawing of a pattern: the same directions for all, so that those of several wavelengths
// are one by the larger distances. Units: stop radii.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "contrejour/vec.h"

namespace contrejour::screens {

class PatternHull {
 public:
  static constexpr std::size_t kLines = 24;

  // Even about the middle, the first to the right.
  [[nodiscard]] static const std::array<Vec2, kLines>& normals();

  [[nodiscard]] double most(std::size_t line) const { return most_[line]; }  // of dot(normals()[line], p)
  [[nodiscard]] bool misses(Vec2 middle, double radius) const;  // a disc, beyond one of the lines

  void hold(Vec2 p);
  void hold(const PatternHull& other, double times = 1.0);  // as many times as large, 0 and more

 private:
  std::array<double, kLines> most_{};
  double nearest_ = 0.0;  // of them
};

}  // namespace contrejour::screens
