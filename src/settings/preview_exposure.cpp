// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/preview_exposure.h"

#include <algorithm>
#include <cmath>

#include "contrejour/expert/metrics.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {
namespace {

constexpr double kExposedQuantile = 0.999;
constexpr double kExposedLevel = 0.7;
constexpr double kMaxExposure_stops = 100.0;

}  // namespace

double automatic_exposure(const Image& rgb) {
  const double bright = quantile_of_samples(rgb, kExposedQuantile);
  if (!(bright > 0.0)) return 0.0;
  return std::clamp(std::log2(kExposedLevel / bright), -kMaxExposure_stops, kMaxExposure_stops);
}

PreviewSettings preview_settings(const Values& values, const Image& rgb, DefaultExposure otherwise) {
  PreviewSettings settings;
  const auto text = values.text("exposure");
  if (text && *text != "auto") {
    settings.exposure_stops = *parse_real(*text);
  } else if (text || otherwise == DefaultExposure::Automatic) {
    settings.exposure_stops = automatic_exposure(rgb);
  }
  return settings;
}

}  // namespace contrejour::params
