// SPDX-License-Identifier: Apache-2.0
// The rays that the published polynomials were fitted to (published_fits.h): those of the thesis's system of two lenses
// (sabatschus2022 5.3), and those of a ghost in zones of the field, as the 2025 work samples them.
// Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/published_fits.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour::published {

// The thesis's example: two biconvex lenses of BK7 with radii of 3 and thicknesses of 1.5, the stop of radius 1 at the
// second one's front, at 500 nm. Elements from the front: 0 and 1 the first lens, 2 the stop, 3 and 4 the second lens.
// Lengths are in units of its scene. Source: the defaults of luksab/polyflare; that they are those of the thesis's
// figures is known from the number of rays that arrive of its grid, 11673 of 13^4, and from its errors.
struct TwoLenses {
  // The code that traces the rays for fits treats every surface that light leaves a lens by as a cylinder, with the
  // ray's distance taken in the y-z plane and the normal from a scaled point. The code that draws traces spheres.
  enum class Tracer : std::uint8_t { AsPublished, Spheres } tracer = Tracer::AsPublished;
  // The sensor's position for which the polynomials were fitted. The program then moves it to 3 and draws there.
  double sensor_z = 7.0;
  // The stop's hexagon blocks rays.
  bool stop = true;
};

inline constexpr double kTwoLensesDrawnSensor_z = 3.0;

// Reflections at elements i < j of TwoLenses, first at j.
using ElementPair = std::pair<int, int>;

struct TwoLensesRay {
  bool arrives = false;
  Vec2 sensor, stop;
};

// The ray from a point light at (x, y, -6), one unit before the first vertex, in the direction (dx, dy, 1). Inputs are
// x, y, dx and dy, each over 0.5. A pair that the system does not have, or with the stop, gives no ray.
[[nodiscard]] CONTREJOUR_API TwoLensesRay trace(const TwoLenses& system, ElementPair ghost, const Inputs& at);

struct RaySamples {
  std::vector<Inputs> inputs;
  std::vector<Vec2> sensor;

  [[nodiscard]] CONTREJOUR_API Samples x() const;
  [[nodiscard]] CONTREJOUR_API Samples y() const;
};

// The rays that arrive of a regular grid of side^4, from -1 on in steps of 2 / side.
[[nodiscard]] CONTREJOUR_API RaySamples grid_samples(const TwoLenses& system, ElementPair ghost, int side);
// Random rays until `count` have arrived, or a hundred times as many were tried.
[[nodiscard]] CONTREJOUR_API RaySamples random_samples(const TwoLenses& system, ElementPair ghost, int count,
                                                       std::uint64_t seed);

struct ZoneSampling {
  int fields = 16;  // evenly spaced, from the axis on
  double largest_field = 0.2;  // tangent
  int rays = 800;  // in each zone
  double margin = 1.1;  // rays are traced up to this multiple of the radii of the stop and of rims
  double lambda_nm = 550.0;
  bool along_field = true;  // the output: the sensor's coordinate along the field, else across
  std::uint64_t seed = 1;
};

struct GhostZones {
  std::vector<double> fields;  // tangents of the light's angle to the axis
  std::vector<ZoneSamples> zones;
  double radius_mm = 0.0;  // of the circle about the axis that holds all entrance points
};

// Zones without light are left out. Errors: InvalidArgument for a ghost that the lens does not have, options out of
// range, or a ghost without light in any zone.
[[nodiscard]] CONTREJOUR_API Result<GhostZones> zone_samples(const LensState& lens, const Ghost& ghost,
                                                             const ZoneSampling& sampling = {});

}  // namespace contrejour::published
