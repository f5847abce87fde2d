// SPDX-License-Identifier: Apache-2.0
// The nearest point of an outline, for many points of one outline: what depends on the outline alone is computed once.
// Thread-safety: const functions may be called at once.
#pragma once

#include <array>

#include "contrejour/expert/ghost_outline.h"
#include "measure/model/outline_cubic.h"

namespace contrejour::inline internal {

class OutlineDistance {
 public:
  explicit OutlineDistance(const GhostOutline& outline);

  [[nodiscard]] OutlinePoint nearest(Vec2 point) const;

 private:
  // The distance from a point inside an outline may have several minima along one cubic: its slope is sampled this
  // finely before they are refined.
  static constexpr int kSamples = 12;

  struct Nearest {
    double squared = 0;
    double t = 0;
  };

  // Half the derivative of the squared distance with respect to t.
  struct Slope {
    double t = 0, value = 0;
  };

  // A cubic relative to the outline's centre.
  struct Arc {
    explicit Arc(const OutlineCubic& relative);

    [[nodiscard]] Nearest nearest(Vec2 point) const;
    [[nodiscard]] Vec2 at(double t) const;
    [[nodiscard]] Vec2 derivative(double t) const;
    [[nodiscard]] Vec2 outward_normal(double t) const;  // unit
    [[nodiscard]] double squared_distance(double t, Vec2 point) const;
    [[nodiscard]] double minimum(Vec2 point, Slope from, Slope to) const;

    Vec2 chord;
    std::array<Vec2, 4> power;  // coefficients of 1, t, t^2, t^3
    // At the samples, the derivative of the cubic, and the cubic times its derivative. Half the derivative of the
    // squared distance from p is `along` - p * `tangent`.
    std::array<double, kSamples + 1> tangent_x{}, tangent_y{}, along{};
  };

  GhostOutline outline_;
  Arc left_, right_;
};

}  // namespace contrejour::inline internal
