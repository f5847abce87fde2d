// SPDX-License-Identifier: Apache-2.0
#include "render/tiled/primitive.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::tiled {
namespace {

struct Span {
  std::int32_t first = 0, last = -1;
};

// Among pixels 0 .. count - 1, those with their middle between the smallest and the largest coordinate.
Span middles_within(const std::array<float, 4>& corners, int count) {
  if (std::any_of(corners.begin(), corners.end(), [](float c) { return std::isnan(c); })) return {};
  const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
  const float first = std::max(std::ceil(*low - 0.5F), 0.0F);
  const float last = std::min(std::floor(*high - 0.5F), static_cast<float>(count - 1));
  if (!(first <= last)) return {};
  return {static_cast<std::int32_t>(first), std::min(static_cast<std::int32_t>(last), count - 1)};
}

}  // namespace

PixelRange pixels_within(const std::array<float, 4>& x, const std::array<float, 4>& y, const Frame& frame) {
  const Span columns = middles_within(x, frame.width);
  const Span rows = middles_within(y, frame.height);
  if (columns.last < columns.first || rows.last < rows.first) return {};
  return {columns.first, rows.first, columns.last, rows.last};
}

}  // namespace contrejour::inline internal::tiled
