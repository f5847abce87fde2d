#include "contrejour/first_order.h"

#include <cmath>
#include <limits>

#include "contrejour/check_lens.h"

namespace contrejour {
namespace {

// Slopes are dy per unit of path length along the axis, so that the same transfer serves both directions of
// travel; a curvature seen from behind changes sign.
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

Abcd abcd_ghost(const LensState& lens, const Ghost& ghost, double lambda_nm, Section section) {
  if (!has_surfaces_of(lens, ghost)) return kNone;
  const auto& all = lens.surfaces;
  const auto surface = [&](int k) -> const SurfaceState& { return all[static_cast<std::size_t>(k)]; };
  const int last = static_cast<int>(all.size()) - 1;
  int at = -1;  // the surface that acted last
  Abcd m;
  const auto act = [&](int k, const Abcd& element) {
    if (at >= 0) m = transfer(std::abs(surface(k).z_mm - surface(at).z_mm)) * m;
    m = element * m;
    at = k;
  };
  const auto forward_to = [&](int end) {
    for (int k = at + 1; k < end; ++k) act(k, refraction_forward(surface(k), lambda_nm, section));
  };
  const auto there_and_back = [&](int far, int near) {
    forward_to(far);
    act(far, reflection(curvature_of(surface(far), section)));
    for (int k = far - 1; k > near; --k) act(k, refraction_backward(surface(k), lambda_nm, section));
    act(near, reflection(-curvature_of(surface(near), section)));
  };
  there_and_back(ghost.j - 1, ghost.i - 1);
  if (ghost.reflects_four_times()) there_and_back(ghost.l - 1, ghost.k - 1);
  forward_to(last + 1);
  return transfer(lens.sensor_z_mm - surface(last).z_mm) * m;
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
  // The stop's centre seen from the scene (y_stop = a y + b u = 0) and from the sensor (y = 0 at the stop).
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
