// SPDX-License-Identifier: Apache-2.0
#include "measure/find/station_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace contrejour::inline internal {
namespace {

constexpr double kOverStations = 0.2;  // the quantile of the steps
constexpr std::size_t kMinStations = 5;

}  // namespace

StationsContrast contrast_over_stations(std::vector<StationStep>& steps) {
  StationsContrast best;
  std::ranges::sort(steps, {}, &StationStep::s);
  std::vector<double> sorted;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    sorted.insert(std::ranges::upper_bound(sorted, steps[k].step), steps[k].step);
    const std::size_t count = k + 1;
    if (count < kMinStations) continue;
    const double low = sorted[static_cast<std::size_t>(kOverStations * static_cast<double>(count))];
    const double contrast = low * std::sqrt(static_cast<double>(count));
    best.signed_contrast = contrast;
    if (contrast > best.contrast) {
      best.contrast = contrast;
      best.first = steps.front().s;
      best.last = steps[k].s;
    }
  }
  return best;
}

double usual_contrast(std::vector<double> contrasts) {
  if (contrasts.size() < 8) return 0.0;
  std::ranges::sort(contrasts);
  return contrasts[contrasts.size() / 2] - contrasts[contrasts.size() / 6];
}

}  // namespace contrejour::inline internal
