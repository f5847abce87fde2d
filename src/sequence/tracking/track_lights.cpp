// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "contrejour/expert/light_tracks.h"
#include "sequence/tracking/light_tracker.h"

namespace contrejour {

FrameLights frame_lights(int frame, const Detection& found, const PixelWindow& data, const PixelWindow& display) {
  const int x = data.x - display.x, y = data.y - display.y;
  FrameLights lights{frame, {x, y, x + data.width, y + data.height}, found.lights};
  for (DetectedLight& light : lights.lights) {
    light.centroid_px = light.centroid_px + Vec2{static_cast<double>(x), static_cast<double>(y)};
    light.min_x += x;
    light.max_x += x;
    light.min_y += y;
    light.max_y += y;
  }
  return lights;
}

std::optional<double> shot_threshold(std::span<const Threshold> thresholds) {
  std::vector<double> levels;
  for (const Threshold& threshold : thresholds)
    if (threshold.source != ThresholdSource::None) levels.push_back(threshold.level);
  if (levels.empty()) return std::nullopt;
  const auto middle = levels.begin() + static_cast<std::ptrdiff_t>(levels.size() / 2);
  std::nth_element(levels.begin(), middle, levels.end());
  return *middle;
}

std::vector<LightTrack> track_lights(std::span<const FrameLights> frames, const TrackingSettings& settings) {
  LightTracker reversed(settings);
  for (const FrameLights& frame : backwards(frames)) reversed.add(frame);
  LightTracker tracker(settings, StartVelocities(reversed.finish()));
  for (const FrameLights& frame : frames) tracker.add(frame);
  return tracker.finish();
}

}  // namespace contrejour
