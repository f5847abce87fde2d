// SPDX-License-Identifier: Apache-2.0
// A section through a lens along its axis, as shapes to be drawn: glass, surfaces, obscurations, stop, sensor, and
// rays. Points are (z, y) in mm, z from the first vertex and y upwards; a light off the axis lies in the plane of the
// section. section_svg() draws them as `contrejour lens draw` does; other programs draw the shapes themselves, with
// polyline() or the arcs as they are. A lens that check_lens() refuses has no shapes. Thread-safety: plain values, pure
// functions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/glass.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

// A piece of a curve, from the piece before it to `to_mm`: straight where the curvature is 0, else the shorter arc of a
// circle whose centre lies at greater z if the curvature (1 / radius) is positive.
struct SectionPiece {
  Vec2 to_mm;
  double curvature_per_mm = 0;
};

struct SectionCurve {
  Vec2 from_mm;
  std::vector<SectionPiece> pieces;
};

// The curve as points, from its first to its last; arcs leave their chords by at most the tolerance.
[[nodiscard]] CONTREJOUR_API std::vector<Vec2> polyline(const SectionCurve& curve, double tolerance_mm = 0.01);

struct SectionElement {  // glass between two surfaces, 0-based
  std::size_t front = 0, rear = 0;
  SectionCurve outline;  // closed: it ends at its beginning
  double index_d = 1;  // of the glass
};

struct SectionSurface {  // any surface but the stop, from its rim at the top to that at the bottom
  std::size_t surface = 0;
  SectionCurve curve;
};

struct SectionStop {  // two blades, from the opening's edge outwards
  double z_mm = 0, opening_mm = 0, outer_mm = 0;  // half heights
};

struct SectionSensor {
  double z_mm = 0, half_height_mm = 0;  // half the diagonal
};

enum class SectionRayKind { Axis, Field, Ghost };

struct SectionRay {
  SectionRayKind kind = SectionRayKind::Axis;
  std::size_t ghost = 0;  // index among the section's ghosts, for rays of a ghost
  std::vector<Vec2> points_mm;
  std::vector<Vec2> reflections_mm;
  bool blocked = false;  // a clear aperture blocks it; it is drawn because no ray passes
};

struct LensSection {
  LensState lens;  // as drawn: a surface without a real rim is as large as the sensor
  std::vector<SectionElement> elements;
  std::vector<SectionSurface> surfaces;
  std::vector<SectionCurve> obscurations;  // along the surface behind each, as far as the section cuts it
  SectionStop stop;
  SectionSensor sensor;
  std::vector<SectionRay> rays;
  std::vector<Ghost> ghosts;
  double ghost_light_deg = 0;  // positive upwards
  double left_mm = 0, right_mm = 1, half_height_mm = 1;  // what a drawing has to show
};

struct SectionRequest {
  double lambda_nm = kLineD_nm;
  std::vector<Ghost> ghosts;  // none: the rays that form the image on the axis and at the corner of the field
  std::optional<double> ghost_light_rad;  // elevation of the ghosts' light; default: a third of the field
};

// Ghosts that the lens does not have get no rays.
[[nodiscard]] CONTREJOUR_API LensSection lens_section(const LensState& lens, const SectionRequest& request = {});

// A page of 1400 pixels' width: the shapes, surfaces' numbers, a legend of the rays, a scale.
[[nodiscard]] CONTREJOUR_API std::string section_svg(const LensSection& section);

// The rims of plates before the sensor are wider than any light needs (SensorStack) and do not count as real.
[[nodiscard]] CONTREJOUR_API bool has_real_rim(const LensState& lens, const SurfaceState& surface);

}  // namespace contrejour
