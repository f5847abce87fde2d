// SPDX-License-Identifier: Apache-2.0
// Leaves out keys that linear interpolation between the others replaces. Thread-safety: a pure function.
#pragma once

#include <functional>
#include <vector>

#include "contrejour/expert/animation.h"

namespace contrejour::inline internal {

// How far a component of a key may be from what is interpolated.
using KeyTolerance = std::function<double(const Key& key, std::size_t component)>;

// Douglas and Peucker 1973: a span without keys is divided where it is farthest from a line. Every key that is left out
// is within the tolerance of the line between its neighbours that are kept.
[[nodiscard]] std::vector<Key> thinned_keys(const std::vector<Key>& keys, const KeyTolerance& tolerance);

}  // namespace contrejour::inline internal
