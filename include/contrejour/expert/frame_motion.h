// SPDX-License-Identifier: Apache-2.0
// How the lens and the lights of a frame change while the shutter is open: a zoom, a rack focus, an iris that closes,
// with lights that move meanwhile. A renderer that has it (Renderer::set_motion) blurs each ghost along its own motion,
// so that the mean over a part of the exposure takes one drawing (docs/physics/motion-blur.md).
#pragma once

#include <algorithm>
#include <vector>

#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour {

// How much each time weighs in a mean: nothing up to rise_from, all the same from full_from to full_to, nothing again
// from fall_to on, with straight lines between. Times are relative to the frame's moment, which is their weighted mean.
struct TimeWindow {
  double rise_from = -1.0, full_from = 0.0, full_to = 0.0, fall_to = 1.0;
};

// The weight of a time, 1 at most.
[[nodiscard]] inline double weight_at(const TimeWindow& window, double time) {
  if (time < window.full_from) return std::max(0.0, (time - window.rise_from) / (window.full_from - window.rise_from));
  if (time > window.full_to) return std::max(0.0, (window.fall_to - time) / (window.fall_to - window.full_to));
  return 1.0;
}

struct FrameMotion {
  LensState lens;  // at a later moment: the frame's lens with another focal length, focus, or iris
  std::vector<Light> lights;  // the frame's lights at that moment, in their order; only their places are used
  double after = 0.1;  // the time from the frame's moment to that one, in any unit
  TimeWindow window;  // the times that the frame is the mean of, in the same unit
};

}  // namespace contrejour
