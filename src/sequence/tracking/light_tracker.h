// SPDX-License-Identifier: Apache-2.0
// Tracks lights frame by frame. Thread-safety: one thread at a time.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "contrejour/expert/light_tracks.h"
#include "sequence/tracking/light_motion.h"
#include "sequence/tracking/start_velocities.h"

namespace contrejour::inline internal {

class LightTracker {
 public:
  explicit LightTracker(const TrackingSettings& settings, StartVelocities starts = {})
      : settings_(settings), starts_(std::move(starts)) {}

  void add(const FrameLights& frame);  // frames in rising order
  [[nodiscard]] std::vector<LightTrack> finish();

 private:
  // The detection of each light, -1 for none. wide: within the whole search radius.
  [[nodiscard]] std::vector<int> pair_up(const FrameLights& frame, bool wide) const;
  void predict(const FrameLights& frame);
  void take_pairs(const FrameLights& frame, std::span<const int> detection_of_light);
  void add_new_lights(const FrameLights& frame, const std::vector<bool>& is_taken);
  void end_lights(const FrameLights& frame);

  TrackingSettings settings_;
  StartVelocities starts_;
  std::vector<LightMotion> motions_;
  std::vector<LightTrack> ended_;
  std::vector<DetectedLight> last_lights_;
};

}  // namespace contrejour::inline internal
