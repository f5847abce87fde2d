// SPDX-License-Identifier: Apache-2.0
// A track in every frame near those that it is seen in, with the fluxes by which it appears and disappears.
// Thread-safety: a pure function.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/light_tracks.h"

namespace contrejour::inline internal {

struct FadedTrack {
  std::vector<TrackPoint> points;  // rising; from the first frame with flux to the last, and one with none beyond each
  std::vector<bool> is_lit;  // of each point: seen or fading
  std::vector<bool> is_seen;
};

// frames: of the shot. A light fades over fade_frames of them beside each that it is seen in; nothing fades beyond the
// ends of the shot, nor where a light leaves another's area.
[[nodiscard]] FadedTrack faded_track(const LightTrack& track, std::span<const int> frames, int fade_frames);

}  // namespace contrejour::inline internal
