// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/pattern_budget.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/budget/frame_error.h"

namespace contrejour::inline internal::adaptive {

double ignored_difference(const BandContext& band, double level) {
  constexpr double kUniform = 5000.0;  // times the negligible level
  return kUniform * band.pattern->negligible_level / std::max(level * peak_limited_weight(level, band.peak), 1e-300);
}

int samples_across_pixel(const BandContext& band, const LinearIrradiance& irradiance, double transmitted,
                         const StopMap& map) {
  constexpr double kMaxSamplesAcross = 6.0;
  constexpr double kOneServes = 8000.0;  // times the negligible level: below, one look-up is enough; found by measuring
  const double level =
      std::max({std::abs(irradiance.value[0]), std::abs(irradiance.value[1]), std::abs(irradiance.value[2])});
  const double fineness = band.pattern->edges != nullptr ? std::min(1.0, map.width() / band.pattern->fringe_unit) : 1.0;
  const double visible = level * peak_limited_weight(level, band.peak) * transmitted * fineness;
  const double negligible = kOneServes * band.pattern->negligible_level;
  return negligible > 0.0
             ? static_cast<int>(std::lround(std::clamp(std::sqrt(visible / negligible), 1.0, kMaxSamplesAcross)))
             : 1;
}

}  // namespace contrejour::inline internal::adaptive
