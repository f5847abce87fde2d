// SPDX-License-Identifier: Apache-2.0
#include "measure/find/station_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace contrejour::inline internal {
namespace {

constexpr double kMostAgainst = 1.0;  // of a station that contradicts: something brighter may lie beside the ghost
constexpr std::size_t kMinStations = 5;
constexpr double kMinRange = 0.33;  // of all stations: near the axis alone, halo and ghosts cannot be told apart

// A step's evidence: proportional to small ones, to the logarithm of large ones, so that a few stations where something
// else is there do not count for more than all others.
double evidence(double step) { return std::max(std::asinh(step), -kMostAgainst); }

}  // namespace

StationsContrast contrast_over_stations(std::vector<StationStep>& steps) {
  StationsContrast best;
  std::ranges::sort(steps, {}, &StationStep::s);
  const double least = kMinRange * static_cast<double>(steps.size());
  double sum = 0.0;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    sum += evidence(steps[k].step);
    const std::size_t count = k + 1;
    if (count < kMinStations || static_cast<double>(count) < least) continue;
    const double contrast = sum / std::sqrt(static_cast<double>(count));
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
