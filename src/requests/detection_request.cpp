// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour {

Result<Detection> detect_lights(const Image& rgb, const params::Values& values) {
  DetectionSettings settings = params::detection_settings(values);
  const auto pixel = [](double fraction, int pixels) {
    return static_cast<int>(std::clamp(std::round(fraction * pixels), -1e9, 1e9));
  };
  for (const std::string& text : values.list("region")) {
    const auto region = params::parse_region(text);
    if (!region) return tl::unexpected(region.error());
    settings.regions.push_back({pixel(region->from.x, rgb.width), pixel(region->from.y, rgb.height),
                                pixel(region->to.x, rgb.width), pixel(region->to.y, rgb.height)});
  }
  return detect_lights(rgb, settings);
}

}  // namespace contrejour
