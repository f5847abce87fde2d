// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/start_velocities.h"

#include <utility>

namespace contrejour::inline internal {

// A track that ends is one that a light begins with. It has a velocity from its third point on; of lights that share an
// area, or have several parts, the positions are not those of detections, so that none is found.
StartVelocities::StartVelocities(std::span<const LightTrack> backwards) {
  constexpr std::size_t kLeastPoints = 3;
  for (const LightTrack& track : backwards) {
    if (track.points.size() < kLeastPoints) continue;
    const TrackPoint& first = track.points.back();
    const TrackPoint& second = track.points[track.points.size() - 2];
    const double frames = first.frame - second.frame;
    starts_[-first.frame].push_back({first.position_px, (second.position_px - first.position_px) * (1.0 / frames)});
  }
}

std::optional<Vec2> StartVelocities::of(int frame, Vec2 position_px) const {
  constexpr double kSame_px = 0.01;  // the same detection
  const auto starts = starts_.find(frame);
  if (starts == starts_.end()) return std::nullopt;
  for (const Start& start : starts->second)
    if (length(start.position_px - position_px) < kSame_px) return start.velocity_px;
  return std::nullopt;
}

std::vector<FrameLights> backwards(std::span<const FrameLights> frames) {
  std::vector<FrameLights> reversed(frames.rbegin(), frames.rend());
  for (FrameLights& frame : reversed) frame.frame = -frame.frame;
  return reversed;
}

}  // namespace contrejour::inline internal
