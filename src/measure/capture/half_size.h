// SPDX-License-Identifier: Apache-2.0
// A raw exposure as three planes of half its size, in DN above black, with a mask of what is not saturated.
// Thread-safety: pure functions.
#pragma once

#include <vector>

#include "contrejour/expert/capture.h"

namespace contrejour::inline internal {

// The mean of exposures with the light blocked.
struct Background {
  std::vector<float> dn;  // of each raw pixel; empty: none was taken, and the black level stands for it
  int frames = 0;
};

struct HalfSize {
  Image signal;  // DN above the background; green is the mean of two pixels
  Image background;  // DN above black that were subtracted, whose noise remains
  int background_frames = 0;
  Image usable;  // 1, or 0 next to a saturated value of the same colour
  double time_s = 0;
};

// saturated: as in MergeSettings.
[[nodiscard]] HalfSize half_size(const RawFrame& frame, const Background& background, double saturated);

// The mean of the frames of this time.
[[nodiscard]] Background background_of_time(std::span<const RawFrame> frames, double time_s);

}  // namespace contrejour::inline internal
