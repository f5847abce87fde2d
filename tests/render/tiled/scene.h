// SPDX-License-Identifier: Apache-2.0
// A traced grid and the primitives made of it.
#pragma once

#include <doctest/doctest.h>

#include "contrejour/render.h"
#include "render/pupils/pupil_search.h"
#include "render/tiled/primitive_builder.h"
#include "support/scenes.h"

namespace contrejour::test {

inline LensState lens_at_f(const char* name, double f_number, double focal_length_mm = 0.0) {
  LensSettings settings;
  settings.f_number = f_number;
  if (focal_length_mm > 0.0) settings.focal_length_mm = focal_length_mm;
  return bundled(name, settings);
}

inline RayGrid traced(const LensState& lens, Ghost ghost, Vec3 direction, int side) {
  const OpticalPath path = ghost_path(lens, ghost, 550.0);
  const ReflectanceTables tables(lens, 550.0);
  const IrisShape iris(lens.iris);
  const EntranceWindow window = entrance_window(lens, direction);
  RayGrid grid;
  const pupils::Pupil pupil = find_pupil(pupils::PupilRays(path, tables, direction, iris, window), {});
  REQUIRE_FALSE(pupil.is_empty());
  grid.trace(path, tables, iris, direction, window.z_mm, pupil.box(), side, PacketPrecision::Double);
  return grid;
}

inline double triangle_area(const tiled::Primitive& p, std::size_t i, std::size_t j, std::size_t k) {
  const auto at = [&](std::size_t n) { return Vec2{p.x[n], p.y[n]}; };
  return 0.5 * cross(at(j) - at(i), at(k) - at(i));
}

// The flux of its two triangles.
inline double flux_of(const tiled::Primitive& p) {
  const auto& e = p.irradiance;
  const double first = triangle_area(p, 0, 1, 2) * (static_cast<double>(e[0]) + e[1] + e[2]) / 3.0;
  if ((p.flags & tiled::kTriangle) != 0) return first;
  return first + triangle_area(p, 0, 2, 3) * (static_cast<double>(e[0]) + e[2] + e[3]) / 3.0;
}

}  // namespace contrejour::test
