// SPDX-License-Identifier: Apache-2.0
// The shape of a pupil: where a ghost's light enters and what bounds it, by grids of rays over the entrance window;
// each grid covers the open part of the one before. Differs from find_pupil(): it follows the rays that get through
// instead of the cells that may transmit light, since it measures areas and borders and need not contain all light.
#pragma once

#include <optional>
#include <vector>

#include "base/linear_map.h"
#include "ghosts/light_frame.h"
#include "optics/trace/lens_steps.h"

namespace contrejour::inline internal::pupils {

inline constexpr int kRims = kMaxStopCrossings;  // follows the stop's crossings

// A ray that gets through, next to one that does not.
struct BorderRay {
  Vec2 start_mm;
  int bound = 0;  // what blocks the other ray: a crossing of the stop, or kRims
};

struct PupilShape {
  int bound = 0;  // the bound that makes most of its border
  double bound_fraction = 1.0;
  bool is_open = false;  // false: no ray gets through; the rest describes the ray blocked least
  double outside = 0.0;  // excess of that ray over what blocks it
  // Start of a ray that gets through: near the middle of the stop where the stop makes nearly all of the border, else
  // near the centroid of all rays that get through.
  Vec2 middle_mm;
  LinearMap covariance = kZeroMap;  // of the starts of all that get through, mm^2
  double area_mm2 = 0.0;  // area that these starts fill
  double border_mm = 0.0;  // approximate length of its border
  std::vector<Vec2> inside_mm;  // starts of some of them, evenly spaced
  std::vector<BorderRay> border;  // some of the rays at the border, evenly spaced

  [[nodiscard]] bool is_whole() const { return is_open && bound != kRims && bound_fraction > 0.85; }
};

// At the wavelength of the steps. Empty where all rays fail. The iris counts as its circumscribed circle. The window is
// in the light's frame, the pupil in the lens's.
[[nodiscard]] std::optional<PupilShape> find_pupil_shape(const LensSteps& steps, const Ghost& ghost,
                                                         const LightFrame& light, const EntranceWindow& window);

}  // namespace contrejour::inline internal::pupils
