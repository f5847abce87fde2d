// SPDX-License-Identifier: Apache-2.0
#include "ghosts/pupils/box_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kFitColumns = 8;
constexpr double kWidening = 0.2;  // of a box's size, on a side whose border transmits light
constexpr int kMaxWidenings = 4;
constexpr float kFitReach = 0.5F;     // ClearanceGrid::may_transmit

}  // namespace

BoxFitter::BoxFitter(PacketPath path, const EntranceWindow& window)
    : grid_(std::move(path)),
      window_{{window.min_mm.x, 0.0}, {window.max_mm.x, std::max(std::abs(window.min_mm.y), window.max_mm.y)}} {}

std::optional<Rectangle> BoxFitter::fit(const Rectangle& box) {
  Rectangle half{{box.low.x, std::max(box.low.y, 0.0)}, box.high};
  for (int step = 0;; ++step) {
    grid_.trace(half, kFitColumns, half.low.y == 0.0 ? kFitColumns / 2 : kFitColumns);
    if (step == kMaxWidenings) break;
    const Rectangle next = grid_.grown(kWidening, window_);
    if (next.low == half.low && next.high == half.high) break;
    half = next;
  }
  std::optional<Rectangle> hull;
  for (const auto& piece : grid_.components(kFitReach)) {
    const Rectangle one = grid_.hull(piece);
    if (!hull) hull = one;
    hull->low = {std::min(hull->low.x, one.low.x), std::min(hull->low.y, one.low.y)};
    hull->high = {std::max(hull->high.x, one.high.x), std::max(hull->high.y, one.high.y)};
  }
  if (hull && hull->low.y == 0.0) hull->low.y = -hull->high.y;
  return hull;
}

}  // namespace contrejour::inline internal::pupils
