// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/shared_areas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal {
namespace {

constexpr double kMargin_px = 1.5;       // between areas that met, or that one light was divided into
constexpr double kMaxFluxOfParts = 1.3;  // of the light before it was divided
constexpr double kMinFluxOfMet = 0.5;    // of the hidden light: how much more flux the area that it is in must have

bool is_part(const LightMotion& motion, const DetectedLight& part) {
  const Vec2 offset = part.centroid_px - motion.predicted_px;
  return std::abs(offset.x) <= motion.half_size_px.x + kMargin_px &&
         std::abs(offset.y) <= motion.half_size_px.y + kMargin_px;
}

}  // namespace

DetectedLight as_one(const DetectedLight& a, const DetectedLight& b) {
  DetectedLight sum = a;
  for (std::size_t c = 0; c < 3; ++c) sum.flux[c] += b.flux[c];
  const double fraction = sum_of(b.flux) / sum_of(sum.flux);
  const Vec2 offset = b.centroid_px - a.centroid_px;
  sum.centroid_px = a.centroid_px + fraction * offset;
  sum.rms_radius_px =
      std::sqrt((1.0 - fraction) * a.rms_radius_px * a.rms_radius_px + fraction * b.rms_radius_px * b.rms_radius_px +
                fraction * (1.0 - fraction) * dot(offset, offset));
  sum.min_x = std::min(a.min_x, b.min_x);
  sum.min_y = std::min(a.min_y, b.min_y);
  sum.max_x = std::max(a.max_x, b.max_x);
  sum.max_y = std::max(a.max_y, b.max_y);
  return sum;
}

bool is_within(const DetectedLight& light, Vec2 point, double margin) {
  return point.x >= light.min_x - margin && point.x <= light.max_x + 1 + margin && point.y >= light.min_y - margin &&
         point.y <= light.max_y + 1 + margin;
}

std::vector<int> lights_of_parts(std::span<const LightMotion> motions, std::span<const DetectedLight> detections,
                                 std::span<const int> detection_of_light) {
  std::vector<int> light_of(detections.size(), -1);
  std::vector<double> flux(motions.size());
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (detection_of_light[k] < 0) continue;
    const auto d = static_cast<std::size_t>(detection_of_light[k]);
    light_of[d] = static_cast<int>(k);
    flux[k] = sum_of(detections[d].flux);
  }
  for (std::size_t d = 0; d < detections.size(); ++d) {
    if (light_of[d] >= 0) continue;
    const double own = sum_of(detections[d].flux);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const double distance = length(detections[d].centroid_px - motions[k].predicted_px);
      if (detection_of_light[k] < 0 || !motions[k].has_velocity() || distance >= nearest ||
          !is_part(motions[k], detections[d]) || flux[k] + own > kMaxFluxOfParts * sum_of(motions[k].flux))
        continue;
      nearest = distance;
      light_of[d] = static_cast<int>(k);
    }
    if (light_of[d] >= 0) flux[static_cast<std::size_t>(light_of[d])] += own;
  }
  return light_of;
}

std::vector<int> detections_shared(std::span<const LightMotion> motions, std::span<const DetectedLight> detections,
                                   std::span<const int> detection_of_light) {
  std::vector<double> expected(detections.size());  // flux of the lights in each detection
  for (std::size_t k = 0; k < motions.size(); ++k)
    if (detection_of_light[k] >= 0)
      expected[static_cast<std::size_t>(detection_of_light[k])] += sum_of(motions[k].flux);
  std::vector<int> shared(motions.size(), -1);
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (detection_of_light[k] >= 0) continue;
    const double own = sum_of(motions[k].flux);
    for (std::size_t d = 0; d < detections.size(); ++d) {
      if (expected[d] == 0.0 || !is_within(detections[d], motions[k].predicted_px, kMargin_px) ||
          sum_of(detections[d].flux) < expected[d] + kMinFluxOfMet * own)
        continue;
      shared[k] = static_cast<int>(d);
      expected[d] += own;
      break;
    }
  }
  return shared;
}

}  // namespace contrejour::inline internal
