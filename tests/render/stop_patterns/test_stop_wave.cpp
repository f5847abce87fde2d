// SPDX-License-Identifier: Apache-2.0
// Fresnel numbers of ghosts: a plate's calculated by hand, lenses' from traced rays.
#include <cmath>

#include "render/stop_patterns/stop_wave.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

// A ray close to the axis: its height and slope where it crosses the stop for the last time, and its height on the
// sensor.
struct NearAxis {
  double at_stop = 0, slope_at_stop = 0, on_sensor = 0;
};

NearAxis traced(const OpticalPath& path, double height_mm, double slope) {
  const Vec3 towards = normalized({0.0, slope, 1.0});
  const RayRecord record = trace_recorded(path, {{0.0, height_mm, 0.0}, towards});
  NearAxis out;
  for (const TraceStep& step : record.steps) {
    if (step.event != PathEvent::Stop) continue;
    out.at_stop = step.position_mm.y;
    out.slope_at_stop = step.direction_after.y / std::abs(step.direction_after.z);
  }
  out.on_sensor = record.ray.sensor_mm.y;
  return out;
}

}  // namespace

TEST_CASE("a plate's ghost: the stop's light goes 1 + 3 * 2 / 1.5 + 7 mm on") {
  const LensState lens = plate();
  const auto wave = stop_patterns::stop_wave(ghost_path(lens, {2, 3}, 550.0));
  CHECK(wave.fresnel_number == test::approx(9.0 / (550e-6 * 12.0)).epsilon(1e-9));
  CHECK(wave.footprint == test::approx(1.0).epsilon(1e-9));
  // A light at 100 mm spreads behind the stop, which is at the first surface: A + B c = 1 + 12 / 100.
  const auto near = stop_patterns::stop_wave(ghost_path(lens, {2, 3}, 550.0), 100.0);
  CHECK(near.fresnel_number == test::approx(1.12 * 9.0 / (550e-6 * 12.0)).epsilon(1e-9));
  CHECK(near.footprint == test::approx(1.12).epsilon(1e-9));
}

TEST_CASE("lenses' ghosts: A, B and the wave at the stop from rays near the axis") {
  for (const char* name : {"heliar", "canon-70-200", "planar-50"}) {
    const LensState lens = bundled(name, {.f_number = 8.0});
    int count = 0;
    for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) {
      if (++count % 17 != 1) continue;
      CAPTURE(name);
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      const OpticalPath path = ghost_path(lens, ghost, 500.0);
      const NearAxis parallel = traced(path, 1e-4, 0.0), tilted = traced(path, 0.0, 1e-6);
      // The linear combination of both that crosses the stop on the axis.
      const double t = parallel.at_stop / tilted.at_stop;
      const double b =
          (parallel.on_sensor - t * tilted.on_sensor) / (parallel.slope_at_stop - t * tilted.slope_at_stop);
      const double a = parallel.on_sensor / parallel.at_stop;
      const auto wave = stop_patterns::stop_wave(path);
      // The sensor's picture may be inverted relative to the stop's coordinates: only the size is compared.
      CHECK(wave.footprint == test::approx(std::abs(a)).epsilon(2e-4));
      const double expected = std::abs(a * lens.stop_radius_mm * lens.stop_radius_mm / (500e-6 * b));
      CHECK(wave.fresnel_number == test::approx(expected).epsilon(2e-4));
    }
  }
}

TEST_CASE("paths without an edge to blur are sharp") {
  OpticalPath path = ghost_path(plate(), {2, 3}, 550.0);
  std::erase_if(path.steps, [](const PathStep& step) { return step.event == PathEvent::Stop; });
  CHECK(std::isinf(stop_patterns::stop_wave(path).fresnel_number));
  CHECK(std::isinf(stop_patterns::stop_wave({}).fresnel_number));
}
