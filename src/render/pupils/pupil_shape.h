// SPDX-License-Identifier: Apache-2.0
// The shape of a pupil: where a ghost's light enters and what bounds it, by grids of rays over the entrance window;
// each grid covers the open part of the one before. Differs from find_pupil(): it follows the rays that get through
// instead of the cells that may transmit light, since it measures areas and borders and need not contain all light.
// Between rays the excess over what blocks them is linear, so that everything moves steadily with the light, however
// the grid lies: what is measured by counting rays would jump from frame to frame of a moving light.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/linear_map.h"
#include "ghosts/light_frame.h"
#include "optics/trace/lens_steps.h"

namespace contrejour::inline internal::pupils {

inline constexpr int kRims = kMaxStopCrossings;  // follows the stop's crossings

// The centroid of a part of the pupil, the fraction of the pupil's area that this part is, and its covariance, mm^2.
struct InnerPoint {
  Vec2 start_mm;
  double fraction = 0.0;
  LinearMap covariance = kZeroMap;
};

// A point of the pupil's border, and the length for which it stands.
struct BorderPoint {
  Vec2 start_mm;
  int bound = 0;  // what blocks the rays outside of it: a crossing of the stop, or kRims
  double length_mm = 0.0;
};

struct PupilShape {
  std::array<double, kMaxStopCrossings + 1> bound_fractions{};  // of its border, by what bounds it
  bool is_open = false;  // false: no ray gets through; the rest describes the ray blocked least
  double outside = 0.0;  // excess of that ray over what blocks it
  Vec2 middle_mm;  // centroid of the pupil, where light need not get through
  LinearMap covariance = kZeroMap;  // of the area that it fills, mm^2
  double area_mm2 = 0.0;
  double border_mm = 0.0;  // length of its border
  std::vector<InnerPoint> inside;
  std::vector<BorderPoint> border;
};

// At the wavelength of the steps. Empty where all rays fail. The iris counts as its circumscribed circle. The window is
// in the light's frame, the pupil in the lens's.
[[nodiscard]] std::optional<PupilShape> find_pupil_shape(const LensSteps& steps, const Ghost& ghost,
                                                         const LightFrame& light, const EntranceWindow& window);

}  // namespace contrejour::inline internal::pupils
