// A grid of a light's rays over the part of the entrance window that the direct image takes, traced in double, with
// what decides whether each gets through.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/lens.h"
#include "contrejour/trace.h"

namespace contrejour {

struct PupilRay {
  bool arrived = false;
  Vec2 entrance_mm;     // in the plane z_mm of the entrance window
  Vec2 cosines;         // at the sensor
  Vec2 stop;            // over the stop's radius
  double transmission = 0;  // times LightSource::flux_at
  double iris = 0;      // distance from the iris's edge in stop radii, negative inside
  double blocked = 0;   // the largest of that and every rim's r_rel - 1
  double obscured = -1; // TracedRay::obscured
};

struct PupilRays {
  int side = 0;
  double z_mm = 0;
  std::vector<PupilRay> rays;    // [row * side + column]
  std::vector<Vec2> rim_places;  // [rim * rays.size() + ray]: over the clear radius, of every refracting surface
  std::size_t rims = 0;
  std::vector<bool> blocks_within;  // by rim: it is an obscuration's

  [[nodiscard]] Vec2 at_rim(std::size_t rim, std::size_t ray) const { return rim_places[rim * rays.size() + ray]; }
};

// None when nothing gets through, or when cancelled.
[[nodiscard]] std::optional<PupilRays> trace_pupil(const LensState& lens, const IrisOpening& iris,
                                                   const LightSource& light, double lambda_nm, const Context& context);

}  // namespace contrejour
