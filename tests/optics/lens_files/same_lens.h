// SPDX-License-Identifier: Apache-2.0
// Compares two lenses, number by number.
#pragma once

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/lens.h"

namespace contrejour::test {

// Tolerances for a lens that was stored in another program's format.
struct SameLens {
  double index = 1e-12;   // of each glass from 400 to 700 nm
  bool z_shifts = true;  // poses to 1e-9; without, gaps may have taken up shifts along the axis
};

inline void check_same_shape(const Surface& s, const Surface& t) {
  CHECK(s.shape.kind == t.shape.kind);
  CHECK(s.shape.conic == t.shape.conic);
  CHECK(s.shape.conic_x == t.shape.conic_x);
  CHECK(std::abs(s.shape.curvature_x_per_mm - t.shape.curvature_x_per_mm) <=
        2e-16 * std::abs(s.shape.curvature_x_per_mm));
  CHECK(std::abs(s.shape.rotation_rad - t.shape.rotation_rad) < 1e-12);
  for (std::size_t p = 0; p < std::max(s.shape.powers.size(), t.shape.powers.size()); ++p) {
    CAPTURE(p);
    CHECK((p < s.shape.powers.size() ? s.shape.powers[p] : 0.0) ==
          (p < t.shape.powers.size() ? t.shape.powers[p] : 0.0));
  }
}

// For a rim that is not a circle, the semi-diameter may be that of the enclosing circle.
inline void check_same_rim(const Surface& s, const Surface& t) {
  REQUIRE(s.aperture.kind == t.aperture.kind);
  if (s.aperture.kind == ApertureKind::Disc) {
    CHECK(s.semi_diameter_mm == t.semi_diameter_mm);
    return;
  }
  CHECK(s.aperture.half_mm == t.aperture.half_mm);
  CHECK(length(s.aperture.centre_mm - t.aperture.centre_mm) < 1e-12);
  CHECK(std::abs(s.aperture.rotation_rad - t.aperture.rotation_rad) < 1e-12);
}

inline void check_same_obscuration(const Obscuration& a, const Obscuration& b) {
  CHECK(a.half_mm == b.half_mm);
  CHECK(length(a.centre_mm - b.centre_mm) < 1e-12);
  CHECK(std::abs(a.rotation_rad - b.rotation_rad) < 1e-12);
}

// All numbers must be equal to the last bit, except angles (1e-12) and indices.
inline void check_same_lens(const Prescription& a, const Prescription& b, const SameLens& how = {}) {
  CHECK(a.f_number == b.f_number);
  CHECK(a.sensor_width_mm == b.sensor_width_mm);
  CHECK(a.sensor_height_mm == b.sensor_height_mm);
  CHECK(a.sensor_distance_mm == b.sensor_distance_mm);
  CHECK(a.stated.wavelength_nm == b.stated.wavelength_nm);
  REQUIRE(a.surfaces.size() == b.surfaces.size());
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) {
    CAPTURE(k);
    const Surface &s = a.surfaces[k], &t = b.surfaces[k];
    CHECK(s.kind == t.kind);
    CHECK(s.curvature_per_mm == t.curvature_per_mm);
    check_same_rim(s, t);
    check_same_obscuration(s.obscuration, t.obscuration);
    check_same_shape(s, t);
    for (double nm = 400.0; nm <= 700.0; nm += 12.5)
      CHECK(std::abs(refractive_index(s.glass_after, nm) - refractive_index(t.glass_after, nm)) < how.index);
    if (!how.z_shifts) continue;
    CHECK(length(s.pose.shift_mm - t.pose.shift_mm) < 1e-9);
    CHECK(length(s.pose.axis - t.pose.axis) < 1e-12);
    const bool zooms = !a.zoom.empty();
    if (!zooms && k + 1 < a.surfaces.size()) CHECK(s.thickness_mm == t.thickness_mm);
  }
  REQUIRE(a.zoom.size() == b.zoom.size());
  for (std::size_t p = 0; p < a.zoom.size(); ++p) {
    CHECK(a.zoom[p].focal_length_mm == b.zoom[p].focal_length_mm);
    REQUIRE(a.zoom[p].thickness_mm.size() == b.zoom[p].thickness_mm.size());
    for (std::size_t k = 0; k < a.zoom[p].thickness_mm.size(); ++k) {
      CHECK(a.zoom[p].thickness_mm[k].first == b.zoom[p].thickness_mm[k].first);
      CHECK(a.zoom[p].thickness_mm[k].second == b.zoom[p].thickness_mm[k].second);
    }
  }
}

}  // namespace contrejour::test
