// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/pattern_budget.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/budget/frame_error.h"

namespace contrejour::inline internal::adaptive {

double ignored_difference(const BandContext& band, double level) {
  constexpr double kEven = 5000.0;  // times the negligible level
  return kEven * band.pattern->unseen / std::max(level * seen_share(level, band.peak), 1e-300);
}

int looks_across_pixel(const BandContext& band, const Shade& shade, double passed, const StopMap& map) {
  constexpr double kMost = 6.0;
  constexpr double kOneServes = 8000.0;  // times the negligible level: below, one look-up is enough; found by measuring
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double fineness = band.pattern->edges != nullptr ? std::min(1.0, map.width() / band.pattern->unit) : 1.0;
  const double seen = level * seen_share(level, band.peak) * passed * fineness;
  const double room = kOneServes * band.pattern->unseen;
  return room > 0.0 ? static_cast<int>(std::lround(std::clamp(std::sqrt(seen / room), 1.0, kMost))) : 1;
}

}  // namespace contrejour::inline internal::adaptive
