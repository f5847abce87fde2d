// SPDX-License-Identifier: Apache-2.0
// Third-order aberrations of a lens, surface by surface: Seidel's sums.
// Source: Welford, Aberrations of Optical Systems (1986), chapters 8 and 10: the object at infinity, the marginal ray
// at the edge of the entrance pupil, the chief ray at the edge of the field. mm of path: W040 = spherical / 8, W131 =
// coma / 2, W222 = astigmatism / 2, W220 = (petzval + astigmatism) / 4, W311 = distortion / 2; W020 = axial_colour / 2
// and W111 = lateral_colour between the two outer wavelengths. A lens without axial symmetry is treated as if its y-z
// section were rotated about the axis. Exact up to rounding. Thread-safety: pure functions.
#pragma once

#include <vector>

#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

struct CONTREJOUR_API SeidelSums {
  double spherical = 0;    // S_I
  double coma = 0;         // S_II
  double astigmatism = 0;  // S_III
  double petzval = 0;      // S_IV
  double distortion = 0;   // S_V
  double axial_colour = 0;    // C_I
  double lateral_colour = 0;  // C_II

  SeidelSums& operator+=(const SeidelSums& other);
};

struct SeidelRequest {
  double lambda_nm = kLineD_nm;
  double short_nm = kLineF_nm, long_nm = kLineC_nm;
  double half_field_rad = 0.1;
};

// The sums of each surface, zero for the stop, at the lens's f-number; their total is the lens's.
[[nodiscard]] CONTREJOUR_API std::vector<SeidelSums> seidel_by_surface(const LensState& lens,
                                                                       const SeidelRequest& request);
[[nodiscard]] CONTREJOUR_API SeidelSums seidel_sums(const LensState& lens, const SeidelRequest& request);

}  // namespace contrejour
