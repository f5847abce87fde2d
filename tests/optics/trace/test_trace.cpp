// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/trace.h"
#include "support/approx.h"
#include "support/csv_lens.h"

using namespace contrejour;

namespace {

// A plane-parallel plate behind a stop, the sensor some way on.
LensState plate(double thickness_mm, double n, double sensor_mm) {
  Prescription lens;
  lens.surfaces = {{SurfaceKind::Stop, 0.0, 2.0, 10.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.0, thickness_mm, 20.0, {"", ConstantIndex{n}}, {}, 0},
                   {SurfaceKind::Refracting, 0.0, 0.0, 20.0, air(), {}, 0}};
  LensState state = test::configured(lens, 10.0);
  state.sensor_z_mm = 2.0 + thickness_mm + sensor_mm;
  return state;
}

Vec3 tilted(double angle) { return {0.0, std::sin(angle), std::cos(angle)}; }

}  // namespace

TEST_CASE("a plate's ghost is shifted by 2 t tan(theta') and has T R R T of its light") {
  const double n = 1.6;
  const double t = 3.0;
  const LensState lens = plate(t, n, 40.0);
  for (const double angle : {0.0, 0.1, 0.5, 1.0}) {
    const Ray ray{{0.3, -0.2, 0.0}, tilted(angle)};
    const TracedRay direct = trace(direct_path(lens, kLineD_nm), ray);
    const TracedRay ghost = trace(ghost_path(lens, {2, 3}, kLineD_nm), ray);
    REQUIRE(ghost.status == RayStatus::Ok);
    const double inside = std::asin(std::sin(angle) / n);
    CHECK(ghost.sensor_mm.y - direct.sensor_mm.y == test::approx(2 * t * std::tan(inside)).epsilon(1e-12));
    CHECK(ghost.direction.y == test::approx(std::sin(angle)).epsilon(1e-12));
    const double r = reflectance({}, 1.0, n, std::cos(angle), kLineD_nm);
    CHECK(ghost.transmission == test::approx((1 - r) * r * r * (1 - r)).epsilon(1e-12));
    CHECK(direct.transmission == test::approx((1 - r) * (1 - r)).epsilon(1e-12));
  }
}

TEST_CASE("a ball lens's ghost ray is turned by 2 theta - 6 theta' in all (secondary rainbow)") {
  const double n = 1.5;
  const double radius = 5.0;
  Prescription ball;
  ball.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 4.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 1.0 / radius, 2 * radius, 4.9, {"", ConstantIndex{n}}, {}, 0},
                   {SurfaceKind::Refracting, -1.0 / radius, 0.0, 4.9, air(), {}, 0}};
  const LensState lens = test::configured(ball, 4.0);
  for (const double height : {0.1, 0.5, 1.5}) {
    const TracedRay ghost = trace(ghost_path(lens, {2, 3}, kLineD_nm), {{0.0, height, 0.0}, {0, 0, 1}});
    REQUIRE(ghost.status == RayStatus::Ok);
    // van de Hulst: deviation after k internal reflections = 2 (i - r) + k (pi - 2 r).
    const double i = std::asin(height / radius);
    const double r = std::asin(height / (n * radius));
    const double deviation = 2 * (i - r) + 2 * (std::numbers::pi - 2 * r);
    CHECK(ghost.direction.y == test::approx(-std::sin(deviation)).epsilon(1e-12));
    CHECK(ghost.direction.z == test::approx(std::cos(deviation)).epsilon(1e-12));
  }
}

TEST_CASE("failures are data") {
  Prescription lens;
  lens.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 4.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.2, 2.0, 4.0, {"", ConstantIndex{1.9}}, {}, 0},
                   {SurfaceKind::Refracting, 0.0, 0.0, 4.0, air(), {}, 0}};
  const LensState state = test::configured(lens, 4.0);
  const OpticalPath path = direct_path(state, kLineD_nm);
  CHECK(trace(path, {{0.0, 7.0, 0.0}, {0, 0, 1}}).status == RayStatus::Missed);
  CHECK(trace(path, {{0.0, 4.95, 0.0}, {0, 0, 1}}).status == RayStatus::TotalReflection);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(trace(path, {{nan, 0.0, 0.0}, {0, 0, 1}}).status == RayStatus::NotFinite);
  CHECK(trace(path, {{0.0, 0.0, 0.0}, {1, 0, 0}}).status == RayStatus::NotFinite);
  CHECK(trace(path, {{0.0, 7.0, 0.0}, {0, 0, 1}}).transmission == 0.0);
}

TEST_CASE("r_rel and stop coordinates tell what blocks a ray") {
  const LensState lens = plate(3.0, 1.5, 20.0);
  const OpticalPath path = direct_path(lens, kLineD_nm);
  const Iris circle;
  const TracedRay inside = trace(path, {{6.0, 0.0, 0.0}, {0, 0, 1}});
  CHECK(inside.relative_height == test::approx(0.3));
  CHECK(inside.stop[0].x == test::approx(0.6));
  CHECK(blocked_by(inside, path, circle) == test::approx(-0.4));
  const TracedRay outside = trace(path, {{15.0, 0.0, 0.0}, {0, 0, 1}});
  CHECK(blocked_by(outside, path, circle) == test::approx(0.5));
  const Iris hexagon{6, 0.0};
  CHECK(blocked_by(trace(path, {{0.0, 9.0, 0.0}, {0, 0, 1}}), path, hexagon) > 0.0);
  CHECK(blocked_by(trace(path, {{9.0, 0.0, 0.0}, {0, 0, 1}}), path, hexagon) < 0.0);
}

TEST_CASE("the entrance window holds every ray that can pass inside surface 1") {
  Prescription bulging;
  bulging.surfaces = {{SurfaceKind::Refracting, 1.0 / 12.0, 5.0, 11.0, {"", ConstantIndex{1.6}}, {}, 0},
                      {SurfaceKind::Stop, 0.0, 5.0, 3.0, {"", ConstantIndex{1.6}}, {}, 0},
                      {SurfaceKind::Refracting, 0.0, 0.0, 11.0, air(), {}, 0}};
  const LensState lens = test::configured(bulging, 3.0);
  for (const double angle : {0.0, 0.4, 0.9, 1.3}) {
    const Vec3 direction = tilted(angle);
    const EntranceWindow window = entrance_window(lens, direction);
    for (int k = 0; k < 2000; ++k) {
      const double r = 11.0 * std::sqrt((k + 0.5) / 2000.0);
      const double azimuth = 2.399963 * k;
      const Vec2 p{r * std::cos(azimuth), r * std::sin(azimuth)};
      const double z = 12.0 - std::sqrt(144.0 - r * r);
      const double back = (window.z_mm - z) / direction.z;
      const double y = p.y + back * direction.y;
      CHECK((p.x >= window.min_mm.x && p.x <= window.max_mm.x && y >= window.min_mm.y && y <= window.max_mm.y));
    }
  }
}

TEST_CASE("the entrance window holds every ray of a point that can pass inside surface 1") {
  for (const double curvature : {1.0 / 12.0, 0.0, -1.0 / 12.0}) {
    Prescription first;
    first.surfaces = {{SurfaceKind::Refracting, curvature, 5.0, 11.0, {"", ConstantIndex{1.6}}, {}, 0},
                      {SurfaceKind::Stop, 0.0, 5.0, 3.0, {"", ConstantIndex{1.6}}, {}, 0},
                      {SurfaceKind::Refracting, 0.0, 0.0, 11.0, air(), {}, 0}};
    const LensState lens = test::configured(first, 3.0);
    const double rim_z = curvature == 0.0 ? 0.0 : (12.0 - std::sqrt(144.0 - 121.0)) * (curvature > 0.0 ? 1.0 : -1.0);
    for (const Vec3 from : {Vec3{0, 0, -0.2}, Vec3{3, -1, -4}, Vec3{50, 20, -60}, Vec3{0, 0, -500}}) {
      const Vec3 point{from.x, from.y, from.z + std::min(0.0, rim_z)};
      const LightSource light(normalized(point * -1.0), length(point));
      REQUIRE(check_source(lens, light).has_value());
      const EntranceWindow window = entrance_window(lens, light);
      CHECK(window.z_mm == test::approx(rim_z));
      int outside = 0;
      for (int k = 0; k < 2000; ++k) {
        const double r = 11.0 * std::sqrt((k + 0.5) / 2000.0);
        const double azimuth = 2.399963 * k;
        const double sag = curvature == 0.0 ? 0.0 : (12.0 - std::sqrt(144.0 - r * r)) * (curvature > 0.0 ? 1.0 : -1.0);
        const Vec3 cap{r * std::cos(azimuth), r * std::sin(azimuth), sag};
        const Vec3 p = point + (cap - point) * ((window.z_mm - point.z) / (cap.z - point.z));
        outside += p.x >= window.min_mm.x && p.x <= window.max_mm.x && p.y >= window.min_mm.y && p.y <= window.max_mm.y
                       ? 0
                       : 1;
      }
      CHECK(outside == 0);
    }
  }
}

TEST_CASE("a light is found again where its chief ray lands, inside and outside the field") {
  Prescription singlet;
  singlet.surfaces = {{SurfaceKind::Stop, 0.0, 2.0, 5.0, air(), {}, 0},
                      {SurfaceKind::Refracting, 1.0 / 60.0, 4.0, 12.0, {"", ConstantIndex{1.6}}, {}, 0},
                      {SurfaceKind::Refracting, -1.0 / 80.0, 0.0, 12.0, air(), {}, 0}};
  const LensState lens = test::configured(singlet, 2.0);
  for (const Vec2 p : {Vec2{0, 0}, Vec2{3, -2}, Vec2{-15, 10}, Vec2{60, 5}, Vec2{300, -200}}) {
    const Vec3 d = direction_for_image_point(lens, p, kLineD_nm);
    CHECK(length(d) == test::approx(1.0));
    const Vec2 back = chief_ray_image_point(lens, d, kLineD_nm);
    CHECK(back.x == test::approx(p.x).epsilon(1e-8));
    CHECK(back.y == test::approx(p.y).epsilon(1e-8));
  }
  // Near lights as well; close to the axis their image points follow from similar triangles through the stop, apart
  // from the singlet's power.
  for (const double distance_mm : {1e6, 500.0, 30.0, 2.0}) {
    CAPTURE(distance_mm);
    for (const Vec2 p : {Vec2{0, 0}, Vec2{3, -2}, Vec2{-15, 10}, Vec2{300, -200}}) {
      const Vec3 d = direction_for_image_point(lens, p, kLineD_nm, distance_mm);
      CHECK(length(d) == test::approx(1.0));
      const Vec2 back = chief_ray_image_point(lens, {d, distance_mm}, kLineD_nm);
      CHECK(back.x == test::approx(p.x).epsilon(1e-8));
      CHECK(back.y == test::approx(p.y).epsilon(1e-8));
    }
    // The stop is in front: a chief ray goes through its middle, which is the first vertex, whatever the distance.
    const Vec3 slanting{0.0, std::sin(0.1), std::cos(0.1)};
    CHECK(chief_ray_image_point(lens, {slanting, distance_mm}, kLineD_nm).y ==
          test::approx(chief_ray_image_point(lens, slanting, kLineD_nm).y).epsilon(1e-8));
  }
  // An inverted image: the light of a source above the axis travels downwards and meets the sensor below.
  const Vec3 from_above{0.0, -std::sin(0.1), std::cos(0.1)};
  CHECK(chief_ray_image_point(lens, from_above, kLineD_nm).y < 0.0);
}
