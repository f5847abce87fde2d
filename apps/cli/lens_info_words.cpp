// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "cli/lens_info_report.h"

namespace contrejour::cli {

std::string glass_name(const Glass& glass) {
  if (is_air(glass)) return "air";
  return glass.name.empty() ? fmt::format("n_d {:.5f}", refractive_index(glass, kLineD_nm)) : glass.name;
}

double thickness_mm(const LensState& lens, std::size_t k) {
  const double next_mm = k + 1 < lens.surfaces.size() ? lens.surfaces[k + 1].z_mm : lens.sensor_z_mm;
  return next_mm - lens.surfaces[k].z_mm;
}

std::string shape_name(double curvature_per_mm, const SurfaceShape& shape) {
  const bool has_powers = std::any_of(shape.powers.begin(), shape.powers.end(), [](double a) { return a != 0.0; });
  const bool is_flat_in_one_section = (curvature_per_mm == 0.0) != (shape.curvature_x_per_mm == 0.0);
  switch (shape.kind) {
    case ShapeKind::Revolution: return shape.is_sphere() ? "" : has_powers ? "asphere" : "conic";
    case ShapeKind::Toroid: return is_flat_in_one_section && !has_powers ? "cylinder" : "toroid";
    case ShapeKind::Biconic: return "biconic";
  }
  return "";
}

const char* kind_name(ApertureKind kind) { return kind == ApertureKind::Ellipse ? "ellipse" : "rectangle"; }

const char* kind_name(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::Refracting: return "refracting";
    case SurfaceKind::Stop: return "stop";
    case SurfaceKind::Sensor: return "sensor";
  }
  return "";
}

}  // namespace contrejour::cli
