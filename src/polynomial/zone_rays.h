// SPDX-License-Identifier: Apache-2.0
// Exact rays of one ghost over a zone of the field: those that a fit is made of, and those left out to test it.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/expert/polynomial.h"
#include "ghosts/ray_grid.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour::inline internal::polynomial {

// A ray through a point of the entrance plane, from a light at the tangent `field` along x.
struct RayStart {
  double field = 0.0;
  Vec2 entrance_mm;
  double area_mm2 = 0.0;  // of the entrance plane that it stands for
};

// Rays at one wavelength, one value a ray.
struct RayTable {
  std::vector<float> sensor_x_mm, sensor_y_mm, transmission, relative_height;
  std::vector<std::array<std::vector<float>, 2>> stop;  // by crossing, over the stop's radius
  std::vector<std::vector<float>> rim_squared;  // by step

  [[nodiscard]] std::size_t size() const { return sensor_x_mm.size(); }
  [[nodiscard]] bool arrives(std::size_t ray) const { return relative_height[ray] < kFailed; }
  // The largest of the relative height and the distances from the stop's centre; above 1 the ray is blocked.
  [[nodiscard]] double clearance(std::size_t ray) const;
};

// Finds and traces the rays of one ghost. All arguments must outlive it.
class GhostRays {
 public:
  GhostRays(const LensState& lens, const StepsByWavelength& steps, const Ghost& ghost, double entrance_z_mm)
      : lens_(lens), steps_(steps), ghost_(ghost), entrance_z_mm_(entrance_z_mm) {}

  // The area of the entrance plane that light uses at a field, with a margin around it; without light low_x_mm >=
  // high_x_mm.
  [[nodiscard]] PolynomialBounds bounds(double field) const;
  // starts: by rising field.
  [[nodiscard]] RayTable trace(std::span<const RayStart> starts, double lambda_nm) const;

 private:
  [[nodiscard]] static LightSource light_at(double field);

  const LensState& lens_;
  const StepsByWavelength& steps_;
  Ghost ghost_;
  double entrance_z_mm_;
};

// Points in the upper half of the bounds of each field, denser towards their border: the k-th `count` points of a
// sequence that fills the square evenly.
[[nodiscard]] std::vector<RayStart> starts_within(std::span<const PolynomialBounds> bounds, int count,
                                                  std::size_t first);

[[nodiscard]] inline bool has_light(const PolynomialBounds& bounds) { return bounds.low_x_mm < bounds.high_x_mm; }
// Bounds at any field of a zone between two with light: those of both about the centre of pupil coordinates, which
// follows the pupil; none elsewhere.
[[nodiscard]] PolynomialBounds bounds_between(const PolynomialZone& zone, double field);

}  // namespace contrejour::inline internal::polynomial
