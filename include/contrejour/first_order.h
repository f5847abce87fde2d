// Paraxial (Gaussian) optics of a lens by ABCD matrices: cardinal points, pupils, conjugates.
// A lens without axial symmetry has figures of its sections with the y-z and the x-z plane, exact where these are its
// planes of symmetry; tilts and decentres do not count.
// Column vectors (height mm, slope dy/dz), slopes not multiplied by n. Exact up to rounding.
// Source: any textbook; Greivenkamp, Field Guide to Geometrical Optics. Thread-safety: pure functions.
#pragma once

#include <span>

#include "contrejour/ghost_id.h"
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
[[nodiscard]] Abcd abcd_between(std::span<const SurfaceState> surfaces, int first, int last, double lambda_nm,
                                Section section = Section::Y);

// From surface 1 to the sensor plane along a ghost's path, of the order 0 at the sensor.
[[nodiscard]] Abcd abcd_ghost(const LensState& lens, const Ghost& ghost, double lambda_nm,
                              Section section = Section::Y);

// Of the y-z section; the f-number and the pupils' diameters are its own too.
struct FirstOrder {
  double focal_length_mm = 0;
  double back_focal_distance_mm = 0;   // last vertex -> rear focal point
  double front_focal_distance_mm = 0;  // first vertex -> front focal point; negative in front of the lens
  double entrance_pupil_position_mm = 0;  // first vertex -> entrance pupil
  double entrance_pupil_diameter_mm = 0;
  double exit_pupil_position_mm = 0;  // sensor -> exit pupil; negative towards the lens
  double exit_pupil_diameter_mm = 0;
  double f_number = 0;
  double sensor_position_mm = 0;  // last vertex -> sensor
  double half_field_rad = 0;      // of the sensor's half diagonal, rectilinear
  double focal_length_x_mm = 0;          // of the x-z section: the same where there is axial symmetry
  double back_focal_distance_x_mm = 0;
};

[[nodiscard]] FirstOrder first_order(const LensState& lens, double lambda_nm);

}  // namespace contrejour
