// SPDX-License-Identifier: Apache-2.0
// The blades of an iris one by one.
#pragma once

#include <vector>

#include "contrejour/expert/iris.h"

namespace contrejour::inline internal {

// The round hole that blades close.
inline constexpr IrisBound kIrisRim{{}, 0.0, {}, 1.0};

[[nodiscard]] Vec2 rotated(Vec2 p, double angle_rad);  // counter-clockwise about the axis

// 0: the rim alone, for less than three blades and more than kMaxBlades.
inline constexpr int kMaxBlades = 100;
[[nodiscard]] inline int blade_count(const Iris& iris) {
  return iris.blades >= 3 && iris.blades <= kMaxBlades ? iris.blades : 0;
}

[[nodiscard]] bool is_regular(const Iris& iris);  // every edge at the same distance
[[nodiscard]] double edge_offset(const Iris& iris, int blade);

// The bound of one blade: its edge has its normal at this angle and is moved outwards by this fraction of its distance.
[[nodiscard]] IrisBound edge_bound(const Iris& iris, double normal_rad, double offset);

// The rim, then the blades in order, without duplicates of earlier bounds.
[[nodiscard]] std::vector<IrisBound> iris_bounds(const Iris& iris);

// True if two bounds differ by rounding at most.
[[nodiscard]] bool same_bound(const IrisBound& a, const IrisBound& b);

}  // namespace contrejour::inline internal
