// The blades of an iris one by one.
#pragma once

#include "contrejour/iris.h"

namespace contrejour {

[[nodiscard]] bool is_regular(const Iris& iris);  // every edge at the same distance
[[nodiscard]] double edge_offset(const Iris& iris, int blade);

// What a blade leaves open, its edge's normal at this angle, moved outwards by this share of its distance.
[[nodiscard]] IrisBound edge_bound(const Iris& iris, double normal_rad, double offset);

}  // namespace contrejour
