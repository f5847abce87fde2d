// SPDX-License-Identifier: Apache-2.0
// Decides whether light may pass through a cell, from the clearances at its corners.
#pragma once

#include <algorithm>
#include <limits>

namespace contrejour::inline internal::pupils {

// The lowest and highest value of a function at a cell's corners; the cell is open where the function is <= 0. The
// function is assumed nearly linear: it falls below its lowest corner by at most `reach` times the corners' difference.
class Extremes {
 public:
  void add(float value) {
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
  }
  [[nodiscard]] bool may_transmit(float reach) const {
    return lowest_ <= 0.0F || lowest_ <= reach * (highest_ - lowest_);
  }

 private:
  float lowest_ = std::numeric_limits<float>::infinity();
  float highest_ = -std::numeric_limits<float>::infinity();
};

}  // namespace contrejour::inline internal::pupils
