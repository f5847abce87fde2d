// SPDX-License-Identifier: Apache-2.0
// Exact rays of one ghost over a zone of the field: those that a fit is made of, and those left out to test it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/polynomial.h"
#include "ghosts/ray_grid.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour::inline internal::polynomial {

// A ray through a point of the entrance plane, from a light at the tangents `field` along x and `field_y` along y.
struct RayStart {
  double field = 0.0;
  Vec2 entrance_mm;
  double area_mm2 = 0.0;  // of the entrance plane that it stands for
  double field_y = 0.0;
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
  // The same for the light's tangents along both axes, for a ghost without axial symmetry. near: bounds of light of a
  // direction close by, if known. everywhere: searches the window so finely that hardly any light is missed.
  [[nodiscard]] AsymmetricBounds bounds(Vec2 tangents, const std::optional<Rectangle>& near, bool everywhere) const;
  // starts: those of one direction in a row.
  [[nodiscard]] RayTable trace(std::span<const RayStart> starts, double lambda_nm) const;

 private:
  [[nodiscard]] static LightSource light_at(Vec2 tangents);

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
[[nodiscard]] inline bool lets_light_in(const AsymmetricBounds& bounds) { return bounds.low_x_mm < bounds.high_x_mm; }
// Bounds at any field of a zone between two with light: those of both about the centre of pupil coordinates, which
// follows the pupil; none elsewhere.
[[nodiscard]] PolynomialBounds bounds_between(const PolynomialZone& zone, double field);

}  // namespace contrejour::inline internal::polynomial
