// SPDX-License-Identifier: Apache-2.0
// The clear part of a surface where its rim is no circle about the axis.
// Lengths are in mm, in the surface's own x and y from its axis. Thread-safety: plain values, pure functions.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/export.h"

namespace contrejour {

enum class ApertureKind : std::uint8_t { Disc, Ellipse, Rectangle };

// The semi-diameter's circle limits the surface as well: a rectangle that reaches beyond it has round corners.
struct ClearAperture {
  ApertureKind kind = ApertureKind::Disc;  // a disc is the semi-diameter's; the other members are then unused
  Vec2 half_mm{};  // semi-axes, or half of the sides
  Vec2 centre_mm{};
  double rotation_rad = 0.0;  // of the aperture's own x axis from the surface's, towards y
  friend bool operator==(const ClearAperture&, const ClearAperture&) = default;
};

// An obstacle before the middle of a surface, such as a mirror lens's secondary mirror. It blocks light wherever an
// optical path crosses the surface.
struct Obscuration {
  Vec2 half_mm{};  // semi-axes of an ellipse; 0: there is none
  Vec2 centre_mm{};
  double rotation_rad = 0.0;  // as of an aperture

  [[nodiscard]] bool any() const { return half_mm.x > 0.0; }
  [[nodiscard]] bool has_axial_symmetry() const { return half_mm.x == half_mm.y && centre_mm == Vec2{}; }
  friend bool operator==(const Obscuration&, const Obscuration&) = default;
};

// A convex bound: the unit disc |coordinates()| <= 1 under an affine map; for a strip, one coordinate of coordinates()
// is always 0.
struct Rim {
  Vec2 centre_mm, u_per_mm, v_per_mm;
  [[nodiscard]] Vec2 coordinates(Vec2 own_mm) const {
    const Vec2 from = own_mm - centre_mm;
    return {dot(u_per_mm, from), dot(v_per_mm, from)};
  }
};

// The rims that light must pass inside, all of them: one for an ellipse, two strips for a rectangle, and in addition
// the semi-diameter's circle unless the aperture lies within it. None for a disc.
[[nodiscard]] CONTREJOUR_API std::vector<Rim> rims_of(const ClearAperture& aperture, double semi_diameter_mm);

// The rim that light must pass outside of.
[[nodiscard]] CONTREJOUR_API Rim rim_of(const Obscuration& obscuration);

}  // namespace contrejour
