#include "render/screens/stop_wave.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contrejour/first_order.h"
#include "contrejour/fresnel.h"
#include "kernels/shape_constants.h"

namespace contrejour::screens {
namespace {

// Slopes are dy per unit of way along the axis, in the direction of travel (first_order.cpp); a curvature seen from
// behind changes its sign.
double curvature_of(const PathStep& step, Section section) {
  return step.shape ? step.shape->vertex_curvature(section) : step.curvature_per_mm;
}

Abcd acting(const PathStep& step, Section section) {
  const double curvature = step.direction * curvature_of(step, section);
  switch (step.event) {
    case PathEvent::Stop: return {};
    case PathEvent::Reflect: return {1.0, 0.0, 2.0 * curvature, 1.0};
    case PathEvent::Refract: break;
  }
  return {1.0, 0.0, -curvature * (step.n_out - step.n_in) / step.n_out, step.n_in / step.n_out};
}

Abcd across(double from_z_mm, double to_z_mm, int direction) {
  return {1.0, direction * (to_z_mm - from_z_mm), 0.0, 1.0};
}

// To the tangent plane of each step, behind which it acts; from the sensor when there is no more.
struct Ray {
  double height = 0.0, slope = 0.0;
};
Ray along(const Abcd& m, Ray r) { return {m.a * r.height + m.b * r.slope, m.c * r.height + m.d * r.slope}; }

StopWave wave_in(const OpticalPath& path, double light_distance_mm, Section section) {
  Ray ray{1.0, 1.0 / light_distance_mm};
  double height_at_stop = 0.0, index_at_stop = 1.0;
  Abcd from_stop;
  bool crossed = false;
  for (std::size_t k = 0; k < path.steps.size(); ++k) {
    const PathStep& step = path.steps[k];
    const bool last = k + 1 == path.steps.size();
    if (step.event == PathEvent::Stop) {
      crossed = true;
      height_at_stop = ray.height;
      index_at_stop = step.n_in;
      from_stop = {};
    }
    // A reflection turns the light round: the way to the next surface has that one's direction.
    const int direction = last ? +1 : path.steps[k + 1].direction;
    const double next_z_mm = last ? path.sensor_z_mm : path.steps[k + 1].z_mm;
    const Abcd on = across(step.z_mm, next_z_mm, direction) * acting(step, section);
    ray = along(on, ray);
    from_stop = on * from_stop;
  }
  if (!crossed) return {};
  // A + B c, c the curvature of the light's wave at the stop: the ray from the light's middle, by its height there.
  const double a = ray.height / height_at_stop;
  const double f = fresnel_number(path.stop_radius_mm, a, from_stop.b / index_at_stop, path.lambda_nm);
  return {std::isnan(f) ? std::numeric_limits<double>::infinity() : f, std::abs(a)};
}

}  // namespace

// Without axial symmetry: the mean of the effective distances (a^2 / (lambda F)) of the two sections.
StopWave stop_wave(const OpticalPath& path, double light_distance_mm) {
  const StopWave in_y = wave_in(path, light_distance_mm, Section::Y);
  const bool one_tells_all = std::all_of(path.steps.begin(), path.steps.end(), [](const PathStep& step) {
    return !step.shape || step.shape->kind == ShapeKind::Revolution;
  });
  if (one_tells_all) return in_y;
  const StopWave in_x = wave_in(path, light_distance_mm, Section::X);
  return {2.0 / (1.0 / in_x.fresnel_number + 1.0 / in_y.fresnel_number), std::midpoint(in_x.footprint, in_y.footprint)};
}

}  // namespace contrejour::screens
