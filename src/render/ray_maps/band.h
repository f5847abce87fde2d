// SPDX-License-Identifier: Apache-2.0
// A band: wavelengths that share one geometry.
// Thread-safety: a value.
#pragma once

#include <cstddef>
#include <vector>

namespace contrejour::inline internal::ray_maps {

// Passes from first to last, excluding last, drawn at one position: that of the middle pass, or one between passes.
struct Band {
  std::size_t first = 0, last = 0;
  std::vector<double> mix{};  // weights of its passes' geometries; empty: that of middle()
  [[nodiscard]] std::size_t middle() const { return (first + last) / 2; }
};

}  // namespace contrejour::inline internal::ray_maps
