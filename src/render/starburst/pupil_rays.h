// SPDX-License-Identifier: Apache-2.0
// A grid of a light's rays over the part of the entrance window that the direct image uses, traced in double precision,
// with the quantities that decide whether each gets through.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/trace.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

struct PupilRay {
  bool arrived = false;
  Vec2 entrance_mm;  // in the entrance window's plane z_mm
  Vec2 cosines;  // at the sensor
  Vec2 stop;  // in stop radii
  double transmission = 0;  // times LightSource::flux_at
  double iris = 0;  // signed distance from the iris's edge in stop radii, negative inside
  double blocked = 0;  // the largest of iris and every rim's relative_height - 1
  double obscured = -1;  // TracedRay::obscured
};

struct PupilRays {
  int side = 0;
  double z_mm = 0;
  std::vector<PupilRay> rays;  // [row * side + column]
  std::vector<Vec2> rim_points;  // [rim * rays.size() + ray]: in clear radii, for every refracting surface
  std::size_t rims = 0;
  std::vector<bool> blocks_within;  // by rim: whether it is that of an obscuration

  [[nodiscard]] Vec2 at_rim(std::size_t rim, std::size_t ray) const { return rim_points[rim * rays.size() + ray]; }
};

// nullopt when nothing gets through, or when cancelled.
[[nodiscard]] std::optional<PupilRays> trace_pupil(const LensState& lens, const IrisOpening& iris,
                                                   const LightSource& light, double lambda_nm, const Context& context);

}  // namespace contrejour::inline internal
