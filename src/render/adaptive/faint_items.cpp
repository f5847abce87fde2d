// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/faint_items.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kFaintLevel = 3e-5;  // of the peak: four stops brighter it is a two-thousandth
// The fraction of the frame's squared error that the squared light of all faint items may make. Their error is less,
// since preview quality is within a tenth of their light.
constexpr double kFaintShare = 0.05;

}  // namespace

void mark_faint_items(std::vector<Item>& items, const std::vector<ItemSize>& sizes, const FrameError& allowed) {
  std::vector<std::size_t> dim;
  std::vector<double> squared(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    const ItemSize& size = sizes[k];
    if (items[k].boxes.empty() || !(size.area_px > 0.0) || size.level > kFaintLevel * allowed.peak) continue;
    squared[k] = size.level * size.level * size.area_px;
    items[k].is_faint = true;
    dim.push_back(k);
  }
  for (const std::size_t k : worth_drawing(std::move(dim), squared, kFaintShare * allowed.squared()))
    items[k].is_faint = false;
}

}  // namespace contrejour::inline internal::adaptive
