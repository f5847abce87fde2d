// SPDX-License-Identifier: Apache-2.0
// A light that is being tracked: where it is expected, and how likely a detection is to be this light.
// Thread-safety: plain values and pure functions.
#pragma once

#include "contrejour/expert/light_tracks.h"

namespace contrejour::inline internal {

[[nodiscard]] inline double sum_of(const Rgb& flux) { return flux[0] + flux[1] + flux[2]; }

struct LightMotion {
  LightTrack track;
  Vec2 position_px;    // as last estimated, in this frame:
  int position_frame = 0;
  Vec2 velocity_px;    // a frame's change
  Vec2 predicted_px;
  Vec2 camera_px;  // the part of the prediction that the camera's unexpected motion adds to all lights
  Rgb flux{};
  double radius_px = 0;
  Vec2 half_size_px;          // of the light's area when it was last seen alone and whole
  double innovation_px = 1;   // how far detections were from the predictions
  int seen = 0, missed = 0;   // frames: in all, and since it was last seen

  bool knows_start = false;   // the velocity after the first frame is that to the second (start_velocities.h)

  [[nodiscard]] bool has_velocity() const { return seen >= 3 || knows_start; }
  [[nodiscard]] bool next_is_known() const { return knows_start && seen == 1; }  // the camera's motion included
};

[[nodiscard]] LightMotion new_motion(int frame, const DetectedLight& light, Vec2 velocity_px);

// The negative logarithm of the likelihood that the detection is the light: 0 if all is as predicted.
// tolerance_px: added to how uncertain the predicted position is.
[[nodiscard]] double cost_of(const LightMotion& motion, const DetectedLight& light, double tolerance_px);

// The distance from the predicted position beyond which a detection is another light.
[[nodiscard]] double search_radius_px(const LightMotion& motion, double search_px);

// The detection is the light. is_whole: it has no other parts.
void take(LightMotion& motion, int frame, const DetectedLight& light, bool is_whole);

// The light is at this position in the area of several lights.
void take_part(LightMotion& motion, int frame, Vec2 position_px, const Rgb& flux);

}  // namespace contrejour::inline internal
