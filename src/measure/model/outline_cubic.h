// SPDX-License-Identifier: Apache-2.0
// The two cubics of an outline's upper half, left and right of its top, and how they move with the outline's
// parameters. Thread-safety: pure functions.
#pragma once

#include <array>

#include "contrejour/expert/ghost_outline.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kCubicParameters = 6;  // the first ones of GhostOutline

struct OutlineCubic {
  std::array<Vec2, 4> control;

  [[nodiscard]] Vec2 at(double t) const;
  [[nodiscard]] Vec2 derivative(double t) const;
  [[nodiscard]] std::array<Vec2, 4> power_basis() const;  // coefficients of 1, t, t^2, t^3
};

// From the left end of the axis to the top, and from the top to the right end.
[[nodiscard]] OutlineCubic left_cubic(const GhostOutline& outline);
[[nodiscard]] OutlineCubic right_cubic(const GhostOutline& outline);

// Derivatives of the point at t with respect to the outline's parameters.
[[nodiscard]] std::array<Vec2, kCubicParameters> left_derivatives(const GhostOutline& outline, double t);
[[nodiscard]] std::array<Vec2, kCubicParameters> right_derivatives(const GhostOutline& outline, double t);

}  // namespace contrejour::inline internal
