// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/flare_visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace contrejour {
namespace {

constexpr double kQuantile = 0.995;  // a ghost that covers 1 / 200 of the frame counts
constexpr double kBlackLevel = 0.01;  // is added to the picture's luminance, in units of white
// A flare that adds a quarter to the picture below it is obvious; one that adds some hundredths can be found.
constexpr double kObvious = 0.25;

double quantile(std::vector<float>& values, double fraction) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double luminance_of(const Image& rgb, std::size_t pixel, ColourSpace space) {
  const float* const p = rgb.pixels.data() + 3 * pixel;
  const double y = luminance({p[0], p[1], p[2]}, space);
  return std::isfinite(y) ? std::max(0.0, y) : 0.0;
}

}  // namespace

FlareVisibility visibility_of(const Image& rgb, const Image& flare, const Detection& found, ColourSpace space) {
  FlareVisibility visibility;
  if (rgb.pixels.size() != flare.pixels.size()) return visibility;
  const std::size_t count = rgb.pixels.size() / 3;
  const bool has_areas = found.area_of_pixel.size() == count;
  std::vector<float> brightness, ratio;
  for (std::size_t k = 0; k < count; ++k) {
    if (has_areas && found.area_of_pixel[k] >= 0) continue;
    const double added = luminance_of(flare, k, space);
    brightness.push_back(static_cast<float>(added));
    ratio.push_back(static_cast<float>(added / (luminance_of(rgb, k, space) + kBlackLevel)));
  }
  visibility.brightest = quantile(brightness, kQuantile);
  visibility.relative_to_picture = quantile(ratio, kQuantile);
  if (visibility.relative_to_picture > 0.0)
    visibility.stops_to_obvious = std::max(0.0, std::log2(kObvious / visibility.relative_to_picture));
  return visibility;
}

}  // namespace contrejour
