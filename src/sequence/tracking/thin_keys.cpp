// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/thin_keys.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace contrejour::inline internal {
namespace {

// How many tolerances a key is from the line between two others.
double error_of(const Key& key, const Key& from, const Key& to, const KeyTolerance& tolerance) {
  const double t = (static_cast<double>(key.frame) - from.frame) / (static_cast<double>(to.frame) - from.frame);
  double largest = 0;
  for (std::size_t c = 0; c < key.numbers.size(); ++c) {
    const double error = std::abs(key.numbers[c] - std::lerp(from.numbers[c], to.numbers[c], t));
    if (error > 0.0) largest = std::max(largest, error / tolerance(key, c));
  }
  return largest;
}

}  // namespace

std::vector<Key> thinned_keys(const std::vector<Key>& keys, const KeyTolerance& tolerance) {
  if (keys.size() < 3) return keys;
  std::vector<bool> is_kept(keys.size());
  is_kept.front() = is_kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> spans{{0, keys.size() - 1}};
  while (!spans.empty()) {
    const auto [from, to] = spans.back();
    spans.pop_back();
    std::size_t farthest = from;
    double largest = 1.0;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double error = error_of(keys[k], keys[from], keys[to], tolerance);
      if (error <= largest) continue;
      largest = error;
      farthest = k;
    }
    if (farthest == from) continue;
    is_kept[farthest] = true;
    spans.push_back({from, farthest});
    spans.push_back({farthest, to});
  }
  std::vector<Key> kept;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (is_kept[k]) kept.push_back(keys[k]);
  return kept;
}

}  // namespace contrejour::inline internal
