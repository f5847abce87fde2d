// SPDX-License-Identifier: Apache-2.0
// A section through a lens along its axis: its glass, and the rays to draw. Points are (z, y) in mm. A light off the
// axis lies in the plane of the section.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/expert/trace.h"
#include "contrejour/lens.h"

namespace contrejour::cli {

enum class RayKind { Axis, Field, Ghost };

struct SectionRay {
  RayKind kind = RayKind::Axis;
  std::size_t ghost = 0;  // index among the section's ghosts, for rays of a ghost
  std::vector<Vec2> points_mm;
  std::vector<Vec2> reflections_mm;
  bool blocked = false;  // a clear aperture blocks it; it is drawn because no ray passes
};

struct Element {  // glass between two surfaces, 0-based
  std::size_t front = 0, rear = 0;
};

struct Section {
  LensState lens;
  std::vector<Element> elements;
  std::vector<SectionRay> rays;
  std::vector<Ghost> ghosts;
  double ghost_light_deg = 0;  // positive upwards
  double left_mm = 0, right_mm = 0, half_height_mm = 0;
};

// The rims of plates before the sensor are wider than any light needs (SensorStack) and do not count as real.
[[nodiscard]] bool has_real_rim(const LensState& lens, const SurfaceState& surface);

struct SectionRequest {
  double lambda_nm = kLineD_nm;
  std::vector<Ghost> ghosts;
  std::optional<double> ghost_light_rad;  // default: a third of the field
};

[[nodiscard]] Section make_section(const LensState& lens, const SectionRequest& request);

// A surface's clear height, limited by a sphere's radius, and its sag there.
[[nodiscard]] double drawn_height_mm(const SurfaceState& surface);
[[nodiscard]] double sag_mm(const SurfaceState& surface, double height_mm);

}  // namespace contrejour::cli
