// SPDX-License-Identifier: Apache-2.0
// Paraxial (Gaussian) optics of a lens by ABCD matrices: cardinal points, pupils, conjugates.
// A lens without axial symmetry has values for the y-z and for the x-z section, exact where these are its planes of
// symmetry; tilts and decentres are ignored.
// Column vectors (height mm, slope dy/dz), slopes not multiplied by n. Exact up to rounding.
// Source: any textbook; Greivenkamp, Field Guide to Geometrical Optics. Thread-safety: pure functions.
#pragma once

#include <optional>
#include <span>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

struct Abcd {
  double a = 1, b = 0, c = 0, d = 1;

  // later * earlier
  friend constexpr Abcd operator*(const Abcd& m, const Abcd& k) {
    return {m.a * k.a + m.b * k.c, m.a * k.b + m.b * k.d, m.c * k.a + m.d * k.c, m.c * k.b + m.d * k.d};
  }
};

// From the tangent plane of surface `first` (before it acts) to that of `last` (after it acted), 0-based.
[[nodiscard]] CONTREJOUR_API Abcd abcd_between(std::span<const SurfaceState> surfaces, int first, int last,
                                               double lambda_nm, Section section = Section::Y);

// From surface 1 to the sensor plane along a ghost's path, of the order 0 at the sensor.
[[nodiscard]] CONTREJOUR_API Abcd abcd_ghost(const LensState& lens, const Ghost& ghost, double lambda_nm,
                                             Section section = Section::Y);

// A ghost's path. In the y-z section, for a distant light.
struct GhostFirstOrder {
  // Distance from the sensor to the paraxial focus of a bundle parallel to the axis after the path, positive behind the
  // sensor: -a / c. None: the bundle leaves parallel.
  std::optional<double> focus_mm;
  double blur_mm = 0;  // diameter on the sensor of the on-axis bundle that the stop transmits; 0 in focus
  // Distance from the sensor to the image of the stop, formed by the surfaces behind the last stop crossing. Near 0 the
  // ghost is an image of the stop that does not move with the light: a pupil ghost.
  std::optional<double> stop_image_mm;
  // The image point of the ghost's chief ray (through the middle of the stop at the first crossing) over that of the
  // direct image: 1 at the direct image, 0 in the middle of the picture, -1 opposite.
  double relative_image_height = 0;
};
[[nodiscard]] CONTREJOUR_API GhostFirstOrder ghost_first_order(const LensState& lens, const Ghost& ghost,
                                                               double lambda_nm);

// Values of the y-z section, the f-number and the pupils' diameters included, unless a member is named x.
struct FirstOrder {
  double focal_length_mm = 0;
  double back_focal_distance_mm = 0;  // last vertex -> rear focal point
  double front_focal_distance_mm = 0;  // first vertex -> front focal point; negative in front of the lens
  double entrance_pupil_position_mm = 0;  // first vertex -> entrance pupil
  double entrance_pupil_diameter_mm = 0;
  double exit_pupil_position_mm = 0;  // sensor -> exit pupil; negative towards the lens
  double exit_pupil_diameter_mm = 0;
  double f_number = 0;
  double sensor_position_mm = 0;  // last vertex -> sensor
  double half_field_rad = 0;  // of the sensor's half diagonal, rectilinear
  double focal_length_x_mm = 0;  // of the x-z section: the same where there is axial symmetry
  double back_focal_distance_x_mm = 0;
};

[[nodiscard]] CONTREJOUR_API FirstOrder first_order(const LensState& lens, double lambda_nm);

}  // namespace contrejour
