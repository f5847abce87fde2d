// SPDX-License-Identifier: Apache-2.0
#include "measure/model/outline_cubic.h"

namespace contrejour::inline internal {
namespace {

// Bernstein polynomials of degree 3.
std::array<double, 4> bernstein(double t) {
  const double u = 1.0 - t;
  return {u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t};
}

}  // namespace

Vec2 OutlineCubic::at(double t) const {
  const auto b = bernstein(t);
  return control[0] * b[0] + control[1] * b[1] + control[2] * b[2] + control[3] * b[3];
}

Vec2 OutlineCubic::derivative(double t) const {
  const double u = 1.0 - t;
  return ((control[1] - control[0]) * (u * u) + (control[2] - control[1]) * (2.0 * u * t) +
          (control[3] - control[2]) * (t * t)) *
         3.0;
}

std::array<Vec2, 4> OutlineCubic::power_basis() const {
  return {control[0], (control[1] - control[0]) * 3.0, (control[2] - control[1] * 2.0 + control[0]) * 3.0,
          control[3] - control[0] + (control[1] - control[2]) * 3.0};
}

OutlineCubic left_cubic(const GhostOutline& o) {
  return {{Vec2{o.centre - o.left, 0.0}, Vec2{o.centre - o.left, o.round_left * o.half_height},
           Vec2{o.centre - o.round_left * o.left, o.half_height}, Vec2{o.centre, o.half_height}}};
}

OutlineCubic right_cubic(const GhostOutline& o) {
  return {{Vec2{o.centre, o.half_height}, Vec2{o.centre + o.round_right * o.right, o.half_height},
           Vec2{o.centre + o.right, o.round_right * o.half_height}, Vec2{o.centre + o.right, 0.0}}};
}

std::array<Vec2, kCubicParameters> left_derivatives(const GhostOutline& o, double t) {
  const auto b = bernstein(t);
  const double q = o.round_left;
  return {Vec2{1.0, 0.0},
          Vec2{-(b[0] + b[1] + q * b[2]), 0.0},
          Vec2{},
          Vec2{0.0, q * b[1] + b[2] + b[3]},
          Vec2{-o.left * b[2], o.half_height * b[1]},
          Vec2{}};
}

std::array<Vec2, kCubicParameters> right_derivatives(const GhostOutline& o, double t) {
  const auto b = bernstein(t);
  const double q = o.round_right;
  return {Vec2{1.0, 0.0},
          Vec2{},
          Vec2{q * b[1] + b[2] + b[3], 0.0},
          Vec2{0.0, b[0] + b[1] + q * b[2]},
          Vec2{},
          Vec2{o.right * b[1], o.half_height * b[2]}};
}

}  // namespace contrejour::inline internal
