// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <doctest/doctest.h>

#include "render/pupils/curved_box.h"
#include "render/ray_maps/ghost_scene.h"
#include "render/ray_maps/lobatto.h"
#include "render/ray_maps/lobatto_rays.h"
#include "support/approx.h"
#include "support/flares.h"

using namespace contrejour;
using namespace contrejour::pupils;
using namespace contrejour::ray_maps;

namespace {

// A ghost with failing rays next to its pupil at this f-number.
test::GhostScene scene_of(Ghost ghost, double f_number = 16.0, double lambda_nm = 550.0) {
  const LensState lens = test::lens_at_f("heliar", f_number);
  const Frame frame = frame_on_sensor(lens, 1920, 1080);
  const Vec2 at = frame.sensor_from_uv({0.70, 0.33});
  return {lens, ghost, direction_for_image_point(lens, at, lens.design_wavelength_nm), lambda_nm};
}

ClearanceGrid grid_of(const test::GhostScene& scene) { return ClearanceGrid(scene.packets()); }

bool is_open(const test::GhostScene& scene, const TracedRay& ray) {
  return ray.status == RayStatus::Ok && ray.relative_height <= 1.0 && blocked_by(ray, scene.path, Iris{}) <= 0.0;
}

// Calls visit(point, fraction) at side x side points all over a box, fraction along x.
template <class Visit>
void for_each_point(const Rectangle& box, int side, const Visit& visit) {
  for (int y = 0; y <= side; ++y) {
    for (int x = 0; x <= side; ++x)
      visit(Vec2{box.low.x + (box.high.x - box.low.x) * x / side, box.low.y + (box.high.y - box.low.y) * y / side});
  }
}

}  // namespace

TEST_CASE("a bend's points are found again, and it stretches as it says") {
  const SideCurve curve{-3.0, 5.0, {0.02, -1e-4}, {-0.01, 2e-4}};
  for (const Vec2 p : {Vec2{-3, 0}, Vec2{1, 4}, Vec2{5, -6}, Vec2{-4, 7}}) {
    const double x = curve.entrance_x(p);
    CHECK(curve.box_x({x, p.y}) == test::approx(p.x).epsilon(1e-12));
    CHECK(curve.entrance_x({p.x + 0.5, p.y}) - curve.entrance_x({p.x - 0.5, p.y}) ==
          test::approx(curve.jacobian_x(p.y)).epsilon(1e-12));
  }
  CHECK(curve.entrance_x({-3.0, 4.0}) == test::approx(-3.0 + 0.02 * 16 - 1e-4 * 256).epsilon(1e-12));
  CHECK(curve.entrance_x({5.0, 4.0}) == test::approx(5.0 - 0.01 * 16 + 2e-4 * 256).epsilon(1e-12));
}

TEST_CASE("a curved box holds all light of its wavelengths and no ray that fails") {
  for (const Ghost ghost : {Ghost{1, 3}, Ghost{1, 5}}) {
    CAPTURE(ghost.i);
    CAPTURE(ghost.j);
    const std::array scenes{scene_of(ghost, 16.0, 640.0), scene_of(ghost, 16.0, 460.0)};
    std::vector<ClearanceGrid> grids{grid_of(scenes[0]), grid_of(scenes[1])};
    Rectangle straight = scenes[0].boxes.front();
    straight = {straight.low * 1.02 - straight.high * 0.02, straight.high * 1.02 - straight.low * 0.02};
    REQUIRE(straight.low.y == -straight.high.y);
    const auto curved = curved_box(grids, straight);
    REQUIRE(curved.has_value());
    for (const test::GhostScene& scene : scenes) {
      int open = 0, failed_before = 0;
      for_each_point(straight, 60, [&](Vec2 p) {
        const TracedRay ray = scene.exact(p).ray;
        failed_before += ray.status != RayStatus::Ok ? 1 : 0;
        if (!is_open(scene, ray)) return;
        ++open;
        const double x = curved->curve.box_x(p);
        CHECK(x > curved->box.low.x);
        CHECK(x < curved->box.high.x);
        CHECK(std::abs(p.y) < curved->box.high.y);
      });
      CHECK(open > 300);
      CHECK(failed_before > 100);
      for_each_point(curved->box, 60, [&](Vec2 p) {
        CHECK(scene.exact({curved->curve.entrance_x(p), p.y}).ray.status == RayStatus::Ok);
      });
    }
  }
}

TEST_CASE("where what fails comes too near to the light there is no curved box") {
  int none = 0;
  for (const Ghost ghost :
       {Ghost{1, 2}, Ghost{1, 3}, Ghost{1, 5}, Ghost{1, 8}, Ghost{2, 3}, Ghost{3, 5}, Ghost{5, 8}}) {
    const test::GhostScene scene = scene_of(ghost, 3.5);
    for (const Rectangle& box : scene.boxes) {
      if (box.low.y != -box.high.y) continue;
      std::vector<ClearanceGrid> grids{grid_of(scene)};
      const auto curved = curved_box(grids, box);
      none += curved ? 0 : 1;
      if (!curved) continue;
      int fail = 0;
      for_each_point(curved->box, 40, [&](Vec2 p) {
        fail += scene.exact({curved->curve.entrance_x(p), p.y}).ray.status == RayStatus::Ok ? 0 : 1;
      });
      CHECK(fail <= 3);  // of 1681, at corners
    }
  }
  CHECK(none > 0);
}

TEST_CASE("a ray set of a curved box: rays of the entrance plane, and their light times the stretch") {
  const test::GhostScene scene = scene_of({1, 5});
  std::vector<ClearanceGrid> grids{grid_of(scene)};
  const auto curved = curved_box(grids, scene.boxes.front());
  REQUIRE(curved.has_value());
  REQUIRE(curved->curve.jacobian_x(curved->box.high.y) < 0.9);
  LobattoTracer tracer(scene.packets(), scene.light);
  tracer.curve(curved->curve);
  const LobattoRays ray_set = tracer.trace(curved->box, 5, PacketPrecision::Double);
  REQUIRE(ray_set.failed == 0);
  const auto points = lobatto_points(5);
  const Vec2 middle = (curved->box.low + curved->box.high) * 0.5, half = (curved->box.high - curved->box.low) * 0.5;
  for (std::size_t node = 0; node < ray_set.count(); ++node) {
    const Vec2 p{middle.x + half.x * points[node % 5], middle.y + half.y * points[node / 5]};
    const TracedRay ray = scene.exact({curved->curve.entrance_x(p), p.y}).ray;
    const Vec2 sensor = scene.light.to_lens_frame({ray_set.sensor_x_mm[node], ray_set.sensor_y_mm[node]});
    CHECK(length(sensor - ray.sensor_mm) < 1e-4);
    CHECK(ray_set.transmission[node] == test::approx(ray.transmission * curved->curve.jacobian_x(p.y)).epsilon(1e-4));
  }
}

TEST_CASE("cells of different sizes in a curved box leave no seams, dim as the ghost is") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 960, 540);
  settings.scope = GhostScope::OneSideOfStop;
  settings.wavelengths = 12;
  const Light light = test::light_at(lens, settings.frame, {0.70, 0.33});
  const Image image = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
  settings.set_error(3e-4);
  const Image truth = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
  // Rows within ghost 1-5 and outside all other edges.
  double worst = 0.0;
  for (int y = 220; y < 320; ++y)
    for (int x = 760; x < 860; ++x)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(image.at(x, y, c) / static_cast<double>(truth.at(x, y, c)) - 1.0));
  CHECK(worst < 0.3);  // of a pixel's light; 0.56 where sides may bend as much as their error allows
}
