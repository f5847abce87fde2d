// SPDX-License-Identifier: Apache-2.0
// A surface's shape (contrejour/expert/surface_shape.h) for the kernels: scaled to stay well within the range of float,
// with the quadric whose intersection is the first guess.
#pragma once

#include <array>

#include "contrejour/expert/surface_shape.h"

namespace contrejour::inline internal {

struct ShapeConstants {
  static constexpr int kTerms = SurfaceShape::kHighestPower / 2;

  ShapeKind kind = ShapeKind::Revolution;
  double curvature = 0, curvature_x = 0;  // 1/mm
  double quadratic = 0, quadratic_x = 0;  // (1 + conic) times the curvature
  int even_terms = 0, odd_terms = 0;
  std::array<double, kTerms> even{};  // of u^(k + 1), u = (r / reach)^2, mm
  std::array<double, kTerms> odd{};  // of u^(k + 1/2)
  double aperture_mm = 1;
  double per_aperture_squared = 1;
  bool rotated = false;
  double cos_rotation = 1, sin_rotation = 0;
  // start_x x^2 + start_y y^2 + start_z z^2 = 2 z: the surface itself where it is a conic or a circular cylinder.
  double start_x = 0, start_y = 0, start_z = 0;

  // As vertex_curvature() of contrejour/expert/surface_shape.h.
  [[nodiscard]] double vertex_curvature(Section section) const {
    const double across = section == Section::Y ? cos_rotation : sin_rotation;
    return kind == ShapeKind::Revolution ? start_y : start_y * across * across + start_x * (1.0 - across * across);
  }
};

// aperture_mm: the radius of the part of the surface that matters.
[[nodiscard]] ShapeConstants shape_constants(double curvature_per_mm, const SurfaceShape& shape, double aperture_mm);

}  // namespace contrejour::inline internal
