// SPDX-License-Identifier: Apache-2.0
// How lights move in the frame after they appear, which no earlier frame tells: from the same shot followed backwards,
// where such a light is one that has been followed for long and leaves. Thread-safety: a plain value.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/light_tracks.h"

namespace contrejour::inline internal {

class StartVelocities {
 public:
  StartVelocities() = default;  // knows none
  // The tracks of the frames in falling order, whose numbers have the other sign.
  explicit StartVelocities(std::span<const LightTrack> backwards);

  // A frame's change of position, to the frame after this one, of a light that appears here; null where it is unknown.
  [[nodiscard]] std::optional<Vec2> of(int frame, Vec2 position_px) const;

 private:
  struct Start {
    Vec2 position_px, velocity_px;
  };
  std::map<int, std::vector<Start>> starts_;  // by frame
};

// The frames in falling order, with numbers of the other sign.
[[nodiscard]] std::vector<FrameLights> backwards(std::span<const FrameLights> frames);

}  // namespace contrejour::inline internal
