// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/first_order.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "contrejour/expert/check_lens.h"
#include "optics/lens/ghost_walk.h"

namespace contrejour {
namespace {

// Slopes are dy per unit of path length along the axis, so that one transfer serves both directions of travel; for
// light from behind a curvature changes sign.
Abcd transfer(double distance_mm) { return {1.0, distance_mm, 0.0, 1.0}; }

Abcd refraction(double n_in, double n_out, double curvature) {
  return {1.0, 0.0, -curvature * (n_out - n_in) / n_out, n_in / n_out};
}

Abcd reflection(double curvature) { return {1.0, 0.0, 2.0 * curvature, 1.0}; }

struct Index {
  double before, after;
};
Index index_at(const SurfaceState& surface, double lambda_nm) {
  return {refractive_index(surface.before, lambda_nm), refractive_index(surface.after, lambda_nm)};
}

double curvature_of(const SurfaceState& s, Section section) {
  return vertex_curvature(s.curvature_per_mm, s.shape, section);
}

Abcd refraction_forward(const SurfaceState& s, double lambda_nm, Section section) {
  if (s.kind == SurfaceKind::Stop) return {};
  const Index n = index_at(s, lambda_nm);
  return refraction(n.before, n.after, curvature_of(s, section));
}

Abcd refraction_backward(const SurfaceState& s, double lambda_nm, Section section) {
  if (s.kind == SurfaceKind::Stop) return {};
  const Index n = index_at(s, lambda_nm);
  return refraction(n.after, n.before, -curvature_of(s, section));
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Abcd kNone{kNan, kNan, kNan, kNan};

}  // namespace

Abcd abcd_between(std::span<const SurfaceState> surfaces, int first, int last, double lambda_nm, Section section) {
  if (first < 0 || last >= static_cast<int>(surfaces.size())) return kNone;
  Abcd m;
  for (int k = first; k <= last; ++k) {
    const auto& s = surfaces[static_cast<std::size_t>(k)];
    if (k > first) m = transfer(s.z_mm - surfaces[static_cast<std::size_t>(k - 1)].z_mm) * m;
    m = refraction_forward(s, lambda_nm, section) * m;
  }
  return m;
}

namespace {

// The matrices from surface 1 to the sensor plane, and to every crossing of the stop.
struct GhostMatrices {
  Abcd to_sensor;
  std::vector<Abcd> to_stop;
};

GhostMatrices matrices_of(const LensState& lens, const Ghost& ghost, double lambda_nm, Section section) {
  GhostMatrices out;
  const SurfaceState* at = nullptr;  // the surface that acted last
  const auto act = [&](int k, const auto& element_of) {
    const SurfaceState& surface = lens.surfaces[static_cast<std::size_t>(k)];
    if (at != nullptr) out.to_sensor = transfer(std::abs(surface.z_mm - at->z_mm)) * out.to_sensor;
    out.to_sensor = element_of(surface) * out.to_sensor;
    at = &surface;
    if (k == lens.stop_index) out.to_stop.push_back(out.to_sensor);
  };
  walk_surfaces(
      lens, ghost,
      [&](int k, int direction) {
        act(k, [&](const SurfaceState& s) {
          return direction > 0 ? refraction_forward(s, lambda_nm, section) : refraction_backward(s, lambda_nm, section);
        });
      },
      [&](int k, int direction, std::array<int, 2>) {
        act(k, [&](const SurfaceState& s) { return reflection(direction * curvature_of(s, section)); });
      });
  out.to_sensor = transfer(lens.sensor_z_mm - at->z_mm) * out.to_sensor;
  return out;
}

Abcd inverse(const Abcd& m) {
  const double det = m.a * m.d - m.b * m.c;
  return {m.d / det, -m.b / det, -m.c / det, m.a / det};
}

std::optional<double> if_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

// Image height of the chief ray over the tangent of the field angle. The ray through the middle of the stop at slope 1
// starts at y = -b / a, with a and b of the matrix to the stop.
double relative_image_height(const Abcd& to_stop, const Abcd& to_sensor) {
  return to_sensor.b - to_sensor.a * to_stop.b / to_stop.a;
}

}  // namespace

Abcd abcd_ghost(const LensState& lens, const Ghost& ghost, double lambda_nm, Section section) {
  if (!has_surfaces_of(lens, ghost)) return kNone;
  return matrices_of(lens, ghost, lambda_nm, section).to_sensor;
}

GhostFirstOrder ghost_first_order(const LensState& lens, const Ghost& ghost, double lambda_nm) {
  GhostFirstOrder g;
  if (!has_surfaces_of(lens, ghost) || !has_stop(lens)) return g;
  const GhostMatrices m = matrices_of(lens, ghost, lambda_nm, Section::Y);
  const int last = static_cast<int>(lens.surfaces.size()) - 1;
  const Abcd to_sensor_plane = transfer(lens.sensor_z_mm - lens.surfaces.back().z_mm);
  const Abcd direct = to_sensor_plane * abcd_between(lens.surfaces, 0, last, lambda_nm);
  const Abcd direct_to_stop = abcd_between(lens.surfaces, 0, lens.stop_index, lambda_nm);

  g.focus_mm = if_finite(-m.to_sensor.a / m.to_sensor.c);
  // The stop crossing with the largest magnification limits the on-axis bundle.
  double height_mm = std::numeric_limits<double>::infinity();
  for (const Abcd& to_stop : m.to_stop) height_mm = std::min(height_mm, lens.stop_radius_mm / std::abs(to_stop.a));
  g.blur_mm = 2.0 * std::abs(m.to_sensor.a) * height_mm;
  // y = b u on the sensor of rays from the middle of the stop, at slopes of d u.
  const Abcd from_stop = m.to_sensor * inverse(m.to_stop.back());
  g.stop_image_mm = if_finite(-from_stop.b / from_stop.d);
  g.relative_image_height =
      relative_image_height(m.to_stop.front(), m.to_sensor) / relative_image_height(direct_to_stop, direct);
  return g;
}

FirstOrder first_order(const LensState& lens, double lambda_nm) {
  if (!has_stop(lens)) return {kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan, kNan};
  const int last = static_cast<int>(lens.surfaces.size()) - 1;
  const Abcd whole = abcd_between(lens.surfaces, 0, last, lambda_nm);
  const Abcd front = abcd_between(lens.surfaces, 0, lens.stop_index, lambda_nm);
  const Abcd rear = abcd_between(lens.surfaces, lens.stop_index, last, lambda_nm);
  const auto z = [&](int k) { return lens.surfaces[static_cast<std::size_t>(k)].z_mm; };

  FirstOrder f;
  f.focal_length_mm = -1.0 / whole.c;
  f.back_focal_distance_mm = -whole.a / whole.c;
  f.front_focal_distance_mm = whole.d / whole.c;
  f.f_number = lens.f_number;
  f.sensor_position_mm = lens.sensor_z_mm - z(last);
  // The images of the stop's centre on the scene's side (y_stop = a y + b u = 0) and on the sensor's (y = 0 at the
  // stop).
  f.entrance_pupil_position_mm = front.b / front.a;
  f.entrance_pupil_diameter_mm = std::abs(f.focal_length_mm) / lens.f_number;
  f.exit_pupil_position_mm = -rear.b / rear.d - f.sensor_position_mm;
  const double n_stop = refractive_index(lens.surfaces[static_cast<std::size_t>(lens.stop_index)].before, lambda_nm);
  const double n_after = refractive_index(lens.surfaces.back().after, lambda_nm);
  const double pupil_magnification = front.a * n_stop / (n_after * rear.d);
  f.exit_pupil_diameter_mm = std::abs(f.entrance_pupil_diameter_mm * pupil_magnification);
  const double half_diagonal = 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm);
  f.half_field_rad = std::atan(half_diagonal / std::abs(f.focal_length_mm));
  f.focal_length_x_mm = f.focal_length_mm;
  f.back_focal_distance_x_mm = f.back_focal_distance_mm;
  if (lens.has_axial_symmetry()) return f;
  const Abcd in_x = abcd_between(lens.surfaces, 0, last, lambda_nm, Section::X);
  f.focal_length_x_mm = -1.0 / in_x.c;
  f.back_focal_distance_x_mm = -in_x.a / in_x.c;
  f.half_field_rad = std::atan(
      0.5 * std::hypot(lens.sensor_width_mm / f.focal_length_x_mm, lens.sensor_height_mm / f.focal_length_mm));
  return f;
}

}  // namespace contrejour
