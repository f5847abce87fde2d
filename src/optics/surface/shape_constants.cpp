// SPDX-License-Identifier: Apache-2.0
#include "optics/surface/shape_constants.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

void set_powers(ShapeConstants& constants, const std::vector<double>& powers) {
  double scale = 1.0;
  for (std::size_t k = 0; k < std::min<std::size_t>(powers.size(), SurfaceShape::kHighestPower); ++k) {
    scale *= constants.aperture_mm;
    if (powers[k] == 0.0) continue;
    const bool is_even = k % 2 == 1;
    const auto term = k / 2;
    (is_even ? constants.even : constants.odd)[term] = powers[k] * scale;
    (is_even ? constants.even_terms : constants.odd_terms) = static_cast<int>(term) + 1;
  }
}

}  // namespace

ShapeConstants shape_constants(double curvature_per_mm, const SurfaceShape& shape, double aperture_mm) {
  ShapeConstants s;
  s.kind = shape.kind;
  s.aperture_mm = aperture_mm;
  s.per_aperture_squared = 1.0 / (aperture_mm * aperture_mm);
  s.curvature = curvature_per_mm;
  s.quadratic = (1.0 + shape.conic) * curvature_per_mm;
  set_powers(s, shape.powers);
  const double blunted =
      vertex_curvature(curvature_per_mm, {.kind = ShapeKind::Revolution, .powers = shape.powers}, Section::Y);
  s.start_y = blunted;
  s.start_z = (1.0 + shape.conic) * blunted;
  if (shape.has_axial_symmetry()) {
    s.start_x = blunted;
    return s;
  }
  s.curvature_x = shape.curvature_x_per_mm;
  s.quadratic_x = (1.0 + (shape.kind == ShapeKind::Biconic ? shape.conic_x : 0.0)) * shape.curvature_x_per_mm;
  s.start_x = s.curvature_x;
  if (std::abs(s.start_x) > std::abs(s.start_y)) s.start_z = s.quadratic_x;
  s.rotated = shape.rotation_rad != 0.0;
  s.cos_rotation = std::cos(shape.rotation_rad);
  s.sin_rotation = std::sin(shape.rotation_rad);
  return s;
}

}  // namespace contrejour::inline internal
