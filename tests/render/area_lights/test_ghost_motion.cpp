// SPDX-License-Identifier: Apache-2.0
// The displacement of a ghost with its light: against rays traced one by one through the same point of the stop.
#include <cmath>
#include <optional>

#include <doctest/doctest.h>

#include "render/area_lights/ghost_motion.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

struct ImagePoint {
  Vec2 start_mm, sensor_mm;
};

// The ray of a light through the middle of the stop at its first crossing, by Newton's method from a starting point.
std::optional<ImagePoint> through_middle(const OpticalPath& path, const LightSource& source, double z_mm,
                                         Vec2 start_mm) {
  const auto traced = [&](Vec2 at) {
    const Vec3 from{at.x, at.y, z_mm};
    return trace(path, {from, source.direction_at(from)});
  };
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 20; ++k) {
    const TracedRay here = traced(start_mm);
    const TracedRay right = traced(start_mm + Vec2{kStep, 0.0}), up = traced(start_mm + Vec2{0.0, kStep});
    for (const TracedRay& ray : {here, right, up})
      if (ray.status != RayStatus::Ok) return std::nullopt;
    if (length(here.stop[0]) < 1e-9) return ImagePoint{start_mm, here.sensor_mm};
    const LinearMap by_start{(right.stop[0] - here.stop[0]) * (1.0 / kStep),
                             (up.stop[0] - here.stop[0]) * (1.0 / kStep)};
    start_mm = start_mm - inverse(by_start)(here.stop[0]);
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("a ghost that the stop bounds moves as its ray through the middle of the stop does") {
  const LensState lens = test::bundled("itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  int checked = 0;
  for (const Vec2 tangents : {Vec2{0.05, 0.03}, Vec2{-0.08, 0.02}, Vec2{0.0, -0.06}}) {
    const LightSource source{normalized(Vec3{tangents.x, tangents.y, 1.0})};
    const LightWindows windows(lens, source);
    for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::OneSideOfStop)) {
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      const GhostMotion motion = ghost_motion(steps, ghost, source, windows);
      if (!motion.is_open) continue;
      const OpticalPath path = ghost_path(lens, ghost, 550.0);
      if (path.stop_crossings != 1) continue;
      const double z_mm = windows.of(true).z_mm, tangent = 1e-4;
      const auto middle = through_middle(path, source, z_mm, {});
      if (!middle || length(motion.centroid_mm - middle->sensor_mm) > 0.05)
        continue;  // rims bound it, or it has two pupils
      const auto right = through_middle(path, offset_source(source, {tangent, 0.0}), z_mm, middle->start_mm);
      const auto up = through_middle(path, offset_source(source, {0.0, tangent}), z_mm, middle->start_mm);
      REQUIRE((right.has_value() && up.has_value()));
      const LinearMap expected{(right->sensor_mm - middle->sensor_mm) * (1.0 / tangent),
                               (up->sensor_mm - middle->sensor_mm) * (1.0 / tangent)};
      const LinearMap off = motion.shift_mm - expected;
      // The shift is the median over the pupil, which differs from the middle ray's in ghosts with much coma.
      CHECK(length(off.x) + length(off.y) < 0.05 * (length(expected.x) + length(expected.y)));
      ++checked;
    }
  }
  CHECK(checked > 60);
}

TEST_CASE("a ghost whose map to the stop folds moves about as fast as its light does") {
  const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 200.0, .f_number = 32.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  const Vec3 middle = direction_for_image_point(lens, {-8.0, -3.2}, 550.0);
  const auto motion_for = [&](Vec2 tangents) {
    const LightSource source = offset_source(LightSource{middle}, tangents);
    return ghost_motion(steps, {3, 11}, source, LightWindows(lens, source));
  };
  // Lights over the sun's disc: at its right, the stop's coordinates follow the middle ray less and less.
  for (const double right : {-0.004, -0.003, -0.002, 0.0, 0.002, 0.004}) {
    CAPTURE(right);
    constexpr double kStep = 2e-4;  // tangent
    const GhostMotion here = motion_for({right, 0.0});
    const Vec2 by_right = (motion_for({right + kStep, 0.0}).centroid_mm - here.centroid_mm) * (1.0 / kStep),
               by_up = (motion_for({right, kStep}).centroid_mm - here.centroid_mm) * (1.0 / kStep);
    const double seen = length(by_right) + length(by_up), found = length(here.shift_mm.x) + length(here.shift_mm.y);
    REQUIRE(here.is_open);
    CHECK(found < 6.0 * seen);
    CHECK(found > seen / 6.0);
  }
}

TEST_CASE("a pupil of two parts is found whole while its light moves") {
  const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0});
  const ReflectanceTables tables(lens, lens.design_wavelength_nm);
  const LensSteps steps(lens, tables);
  double last_mm2 = 0.0;
  for (int step = 0; step < 30; ++step) {
    CAPTURE(step);
    // By 0.3 of a pixel of a frame of 160 x 90, in which a light of the flicker's shot moves for 90 frames.
    const Vec2 at_mm{-9.2 - 0.065 * step, -2.6 + 0.02 * step};
    const LightSource source{direction_for_image_point(lens, at_mm, lens.design_wavelength_nm)};
    const double flux_mm2 = ghost_motion(steps, {9, 22}, source, LightWindows(lens, source)).flux_mm2;
    REQUIRE(flux_mm2 > 0.0);
    if (step > 0) CHECK(std::abs(flux_mm2 / last_mm2 - 1.0) < 0.05);
    last_mm2 = flux_mm2;
  }
}
