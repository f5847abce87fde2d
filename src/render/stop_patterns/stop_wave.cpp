// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/stop_wave.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/fresnel.h"
#include "optics/surface/shape_constants.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

// Slopes are dy per unit of distance along the axis, in the direction of travel (first_order.cpp); the sign of a
// curvature changes when light travels backwards.
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

// A ray at the tangent plane of the current step, behind which the step acts; after the last step, at the sensor.
struct Ray {
  double height = 0.0, slope = 0.0;
};
Ray along(const Abcd& m, Ray r) { return {m.a * r.height + m.b * r.slope, m.c * r.height + m.d * r.slope}; }

// What follows behind a plane: the height there of the ray from the light's centre, and the matrix from there to the
// sensor.
struct Crossing {
  double height = 1.0, index = 1.0;
  Abcd to_sensor;
};

struct Walk {
  double height_at_sensor = 0.0;
  Crossing front;
  std::vector<Crossing> stops;

  // A + B c, with c the curvature of the light's wave there: the ratio of heights of the ray from the light's centre.
  [[nodiscard]] double magnification(const Crossing& at) const { return height_at_sensor / at.height; }
};

Walk walk(const OpticalPath& path, double light_distance_mm, Section section) {
  Walk out;
  Ray ray{1.0, 1.0 / light_distance_mm};
  for (std::size_t k = 0; k < path.steps.size(); ++k) {
    const PathStep& step = path.steps[k];
    const bool last = k + 1 == path.steps.size();
    if (step.event == PathEvent::Stop) out.stops.push_back({ray.height, step.n_in, {}});
    // A reflection reverses the light: the distance to the next surface has the direction of that one.
    const int direction = last ? +1 : path.steps[k + 1].direction;
    const double next_z_mm = last ? path.sensor_z_mm : path.steps[k + 1].z_mm;
    const Abcd on = across(step.z_mm, next_z_mm, direction) * acting(step, section);
    ray = along(on, ray);
    out.front.to_sensor = on * out.front.to_sensor;
    for (Crossing& stop : out.stops) stop.to_sensor = on * stop.to_sensor;
  }
  out.height_at_sensor = ray.height;
  return out;
}

StopWave wave_in(const OpticalPath& path, double light_distance_mm, Section section) {
  const Walk all = walk(path, light_distance_mm, section);
  if (all.stops.empty()) return {};
  const Crossing& stop = all.stops.back();
  const double a = all.magnification(stop);
  const double f = fresnel_number(path.stop_radius_mm, a, stop.to_sensor.b / stop.index, path.lambda_nm);
  return {std::isnan(f) ? std::numeric_limits<double>::infinity() : f, std::abs(a)};
}

PlaneWave wave_of(const Walk& all, const Crossing& at) {
  const double a = all.magnification(at);
  const double distance = std::abs(at.to_sensor.b / (at.index * a));
  return {std::isnan(distance) ? 0.0 : distance, std::abs(a)};
}
PlaneWave mean_of(const PlaneWave& x, const PlaneWave& y) {
  return {std::midpoint(x.distance_mm, y.distance_mm), std::midpoint(x.magnification, y.magnification)};
}

bool one_section_tells_all(const OpticalPath& path) {
  return std::all_of(path.steps.begin(), path.steps.end(),
                     [](const PathStep& step) { return !step.shape || step.shape->kind == ShapeKind::Revolution; });
}

}  // namespace

// Without axial symmetry this is the mean of the effective distances (a^2 / (lambda F)) of the two sections.
StopWave stop_wave(const OpticalPath& path, double light_distance_mm) {
  const StopWave in_y = wave_in(path, light_distance_mm, Section::Y);
  if (one_section_tells_all(path)) return in_y;
  const StopWave in_x = wave_in(path, light_distance_mm, Section::X);
  return {2.0 / (1.0 / in_x.fresnel_number + 1.0 / in_y.fresnel_number), std::midpoint(in_x.footprint, in_y.footprint)};
}

std::vector<PlaneWave> stop_crossing_waves(const OpticalPath& path, double light_distance_mm) {
  const bool one = one_section_tells_all(path);
  const Walk in_y = walk(path, light_distance_mm, Section::Y);
  const Walk in_x = one ? in_y : walk(path, light_distance_mm, Section::X);
  std::vector<PlaneWave> waves;
  for (std::size_t c = 0; c < in_y.stops.size(); ++c)
    waves.push_back(mean_of(wave_of(in_x, in_x.stops[c]), wave_of(in_y, in_y.stops[c])));
  return waves;
}

PlaneWave front_wave(const OpticalPath& path, double light_distance_mm) {
  const Walk in_y = walk(path, light_distance_mm, Section::Y);
  if (one_section_tells_all(path)) return wave_of(in_y, in_y.front);
  const Walk in_x = walk(path, light_distance_mm, Section::X);
  return mean_of(wave_of(in_x, in_x.front), wave_of(in_y, in_y.front));
}

}  // namespace contrejour::inline internal::stop_patterns
