// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/light_detection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "image/light_areas.h"

namespace contrejour {
namespace {

// Orders by flux, and equal ones by position, so that the order never depends on the sort.
bool comes_first(const DetectedLight& a, const DetectedLight& b) {
  const double flux_a = total_flux(a), flux_b = total_flux(b);
  return flux_a != flux_b ? flux_a > flux_b
                          : std::tie(a.centroid_px.y, a.centroid_px.x) < std::tie(b.centroid_px.y, b.centroid_px.x);
}

std::size_t nearest(const std::vector<Vec2>& centroids, Vec2 point) {
  std::size_t best = 0;
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < centroids.size(); ++i) {
    const Vec2 offset = centroids[i] - point;
    const double distance = dot(offset, offset);
    if (distance >= best_distance) continue;
    best = i;
    best_distance = distance;
  }
  return best;
}

// Merges each weak light into the strong one that was nearest before any merge, so that order does not matter.
void merge_tail(std::vector<DetectedLight>& lights, std::size_t kept) {
  std::vector<Vec2> centroids;
  for (std::size_t i = 0; i < kept; ++i) centroids.push_back(lights[i].centroid_px);
  for (std::size_t i = kept; i < lights.size(); ++i) {
    DetectedLight& target = lights[nearest(centroids, lights[i].centroid_px)];
    target = merged(target, lights[i]);
  }
  lights.resize(kept);
  std::sort(lights.begin(), lights.end(), comes_first);
}

bool is_picture(const Image& rgb) {
  return rgb.channels == 3 && rgb.width >= 0 && rgb.height >= 0 && rgb.pixels.size() == rgb.index(0, rgb.height);
}

// True if the detection was made in an image of this size.
bool is_of(const Detection& detection, const Image& rgb) {
  const auto areas = static_cast<std::int32_t>(detection.areas.size());
  return is_picture(rgb) && 3 * detection.area_of_pixel.size() == rgb.pixels.size() &&
         std::all_of(detection.area_of_pixel.begin(), detection.area_of_pixel.end(),
                     [areas](std::int32_t area) { return area < areas; });
}

AreaSettings settings_of(const Detection& detection) {
  return {detection.threshold, detection.softness, detection.max_value};
}

Result<void> check(const Image& rgb, const DetectionSettings& settings) {
  if (!is_picture(rgb))
    return failure(ErrorCode::InvalidArgument, "lights are looked for in an image of three channels");
  if (settings.threshold && !(std::isfinite(*settings.threshold) && *settings.threshold >= 0))
    return failure(ErrorCode::InvalidArgument, "the threshold for lights must be 0 or more");
  if (!(std::isfinite(settings.softness) && settings.softness >= 0))
    return failure(ErrorCode::InvalidArgument, "the softness of the threshold must be 0 or more");
  if (!(settings.max_value > 0 && settings.max_value <= DetectionSettings::kMaxLevel))
    return failure(ErrorCode::InvalidArgument, "the most that a pixel counts for must be above 0 and at most 1e10");
  if (settings.max_lights < 1 || settings.min_pixels < 1)
    return failure(ErrorCode::InvalidArgument, "the largest number of lights and their least size must be 1 or more");
  return {};
}

Image black_outside(const Image& rgb, const std::vector<PixelRegion>& regions) {
  Image within(rgb.width, rgb.height);
  for (const PixelRegion& region : regions) {
    const int x0 = std::clamp(region.x0, 0, rgb.width), x1 = std::clamp(region.x1, x0, rgb.width);
    for (int y = std::max(0, region.y0); y < std::min(rgb.height, region.y1); ++y)
      std::copy(rgb.pixels.begin() + static_cast<std::ptrdiff_t>(rgb.index(x0, y)),
                rgb.pixels.begin() + static_cast<std::ptrdiff_t>(rgb.index(x1, y)),
                within.pixels.begin() + static_cast<std::ptrdiff_t>(rgb.index(x0, y)));
  }
  return within;
}

void find_brightest(const Image& rgb, Detection& detection) {
  for (int y = 0; y < rgb.height; ++y) {
    for (int x = 0; x < rgb.width; ++x) {
      const double level = level_of(rgb.pixels.data() + rgb.index(x, y));
      if (!(level > detection.brightest)) continue;
      detection.brightest = level;
      detection.brightest_px = {x + 0.5, y + 0.5};
    }
  }
}

// The whole picture's threshold; if nothing in the regions exceeds it, the brightest pixels there are the lights that
// the user meant.
Threshold threshold_for(const Image& picture, const Image& within, double brightest,
                        const DetectionSettings& settings) {
  if (settings.threshold) return {*settings.threshold, ThresholdSource::Given};
  const Threshold automatic = automatic_threshold(picture);
  if (settings.regions.empty() || automatic.level < brightest) return automatic;
  const double level = threshold_of_brightest(within);
  return level > 0.0 ? Threshold{level, ThresholdSource::Region} : automatic;
}

}  // namespace

Result<Detection> detect_lights(const Image& picture, const DetectionSettings& settings) {
  const Result<void> usable = check(picture, settings);
  if (!usable) return tl::unexpected(usable.error());
  const Image within = settings.regions.empty() ? Image() : black_outside(picture, settings.regions);
  const Image& rgb = settings.regions.empty() ? picture : within;
  Detection detection;
  find_brightest(rgb, detection);
  const Threshold threshold = threshold_for(picture, rgb, detection.brightest, settings);
  detection.threshold = threshold.level;
  detection.source = threshold.source;
  detection.softness = settings.softness;
  detection.max_value = settings.max_value;
  detection.areas = bright_areas(rgb, settings_of(detection), detection.area_of_pixel);
  for (std::size_t k = 0; k < detection.area_of_pixel.size(); ++k)
    if (detection.area_of_pixel[k] >= 0 && level_of(rgb.pixels.data() + 3 * k) > settings.max_value)
      ++detection.capped_pixels;
  detection.lights = detection.areas;
  std::erase_if(detection.lights, [&](const DetectedLight& l) { return l.pixel_count < settings.min_pixels; });
  detection.areas_found = static_cast<int>(detection.lights.size());
  std::sort(detection.lights.begin(), detection.lights.end(), comes_first);
  const auto max_lights = static_cast<std::size_t>(settings.max_lights);
  if (detection.lights.size() > max_lights) merge_tail(detection.lights, max_lights);
  return detection;
}

Image picture_of_areas(const Image& rgb, const Detection& detection, const DetectedLight& light) {
  if (!is_of(detection, rgb) || light.min_x < 0 || light.min_y < 0 || light.max_x >= rgb.width ||
      light.max_y >= rgb.height || light.min_x > light.max_x || light.min_y > light.max_y)
    return {};
  const AreaSettings settings = settings_of(detection);
  Image out(light.max_x - light.min_x + 1, light.max_y - light.min_y + 1);
  std::vector<bool> is_its(detection.areas.size());
  for (const int area : light.areas)
    if (area >= 0 && static_cast<std::size_t>(area) < is_its.size()) is_its[static_cast<std::size_t>(area)] = true;
  for (int y = light.min_y; y <= light.max_y; ++y) {
    for (int x = light.min_x; x <= light.max_x; ++x) {
      const std::int32_t area = detection.area_of_pixel[rgb.index(x, y) / 3];
      if (area < 0 || !is_its[static_cast<std::size_t>(area)]) continue;
      const float* const pixel = rgb.pixels.data() + rgb.index(x, y);
      const double weight = weight_of(level_of(pixel), settings);
      for (int c = 0; c < 3; ++c)
        out.at(x - light.min_x, y - light.min_y, c) = static_cast<float>(weight * usable_sample(pixel[c]));
    }
  }
  return out;
}

Image light_matte(const Image& rgb, const Detection& detection) {
  if (!is_of(detection, rgb)) return {};
  const AreaSettings settings = settings_of(detection);
  Image matte(rgb.width, rgb.height, 1);
  for (std::size_t k = 0; k < matte.pixels.size(); ++k)
    if (detection.area_of_pixel[k] >= 0)
      matte.pixels[k] = static_cast<float>(matte_weight(level_of(rgb.pixels.data() + 3 * k), settings));
  return matte;
}

}  // namespace contrejour
