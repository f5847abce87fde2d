// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/resampled.h"

#include <algorithm>
#include <cstddef>

namespace contrejour::inline internal::stop_patterns {
namespace {

// The position of a sample of one grid between two samples of another, along one axis.
struct Between {
  std::size_t low = 0, high = 0;
  float to_high = 0.0F;
  float inside = 1.0F;
};

std::vector<Between> positions_between(int side, double extent, const SquareSamples& from) {
  std::vector<Between> out;
  for (int k = 0; k < side; ++k) {
    const double p = (k + 0.5) * 2.0 * extent / side - extent;
    const double at = (p + from.extent) * 0.5 * from.side / from.extent - 0.5;
    const double inside = std::clamp(std::min(at + 1.0, from.side - at), 0.0, 1.0);
    const double within = std::clamp(at, 0.0, from.side - 1.0);
    const int low = std::min(static_cast<int>(within), std::max(from.side - 2, 0));
    out.push_back({static_cast<std::size_t>(low), static_cast<std::size_t>(std::min(low + 1, from.side - 1)),
                   static_cast<float>(within - low), static_cast<float>(inside)});
  }
  return out;
}

}  // namespace

// Interpolates between rows first, since that uses whole vectors.
std::vector<float> resampled(const SquareSamples& from, int side, double extent) {
  const auto positions = positions_between(side, extent, from);
  const auto count = static_cast<std::size_t>(from.side);
  std::vector<float> out, row(count);
  out.reserve(positions.size() * positions.size());
  for (const Between& y : positions) {
    const float* const above = from.samples.data() + y.low * count;
    const float* const below = from.samples.data() + y.high * count;
    for (std::size_t k = 0; k < count; ++k) row[k] = (above[k] + y.to_high * (below[k] - above[k])) * y.inside;
    for (const Between& x : positions) out.push_back((row[x.low] + x.to_high * (row[x.high] - row[x.low])) * x.inside);
  }
  return out;
}

}  // namespace contrejour::inline internal::stop_patterns
