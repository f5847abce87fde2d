#include "cli/exposure.h"

#include <algorithm>
#include <cmath>

#include "contrejour/metrics.h"
#include "contrejour/parameter_text.h"

namespace contrejour::cli {
namespace {

constexpr double kBrightShare = 0.999;
constexpr double kBrightLevel = 0.7;

double automatic_exposure(const Image& rgb) {
  const double bright = quantile_of_samples(rgb, kBrightShare);
  return bright > 0.0 ? std::clamp(std::log2(kBrightLevel / bright), -100.0, 100.0) : 0.0;
}

}  // namespace

PreviewSettings preview_settings(const params::Values& values, const Image& rgb, UsualExposure usual) {
  PreviewSettings settings;
  const auto text = values.text("exposure");
  if (text && *text != "auto") {
    settings.exposure_stops = *params::parse_real(*text);
  } else if (text || usual == UsualExposure::Automatic) {
    settings.exposure_stops = automatic_exposure(rgb);
  }
  return settings;
}

}  // namespace contrejour::cli
