// SPDX-License-Identifier: Apache-2.0
// Surfaces that are not spheres: sags and normals against another program's, rays against closed forms, first order
// against an independent paraxial trace.
#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/trace.h"
#include "optics/trace/packet_trace.h"
#include "shared_data.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using contrejour::test::bundled;
using contrejour::test::shared_data;

namespace {

SurfaceShape even_asphere(double conic, std::vector<double> powers) {
  return {.conic = conic, .powers = std::move(powers)};
}
SurfaceShape toroid(double curvature_x) { return {.kind = ShapeKind::Toroid, .curvature_x_per_mm = curvature_x}; }

// One surface between air and glass of n = 1.6, its vertex at z = 0.
LensState one_surface(double curvature, const SurfaceShape& shape, double n = 1.6) {
  LensState lens;
  SurfaceState s;
  s.curvature_per_mm = curvature;
  s.shape = shape;
  s.semi_diameter_mm = 8.0;
  s.before = air();
  s.after = {"", ConstantIndex{n}};
  lens.surfaces = {s};
  lens.sensor_z_mm = 100.0;
  return lens;
}

RayRecord meet(double curvature, const SurfaceShape& shape, const Ray& ray) {
  return trace_recorded(direct_path(one_surface(curvature, shape), 550.0), ray);
}

std::vector<std::pair<double, SurfaceShape>> any_shapes() {
  return {{1.0 / 27, even_asphere(0.3, {0, 1e-3, 0, -1e-5, 0, 2e-8, 0, 1e-10})},
          {-1.0 / 19, even_asphere(-2.5, {0, 0, 0, 4e-5, 0, -2e-7})},
          {1.0 / 40, even_asphere(0.0, {2e-3, -1e-3, 1e-4, 0, 3e-6})},
          {0.0, even_asphere(0.0, {0, 4e-3, 0, 1e-5})},
          {1.0 / 30,
           {.kind = ShapeKind::Toroid,
            .conic = -0.7,
            .powers = {0, 0, 0, 1e-5},
            .curvature_x_per_mm = -1.0 / 22,
            .rotation_rad = 0.4}},
          {-1.0 / 25, {.kind = ShapeKind::Toroid, .curvature_x_per_mm = 0.0, .rotation_rad = -1.2}},
          {0.0, toroid(1.0 / 15)},
          {1.0 / 30,
           {.kind = ShapeKind::Biconic,
            .conic = 0.4,
            .curvature_x_per_mm = 1.0 / 18,
            .conic_x = -3.0,
            .rotation_rad = 2.0}}};
}

}  // namespace

// Optiland's tests state the numbers, its test file the surfaces (tests/test_geometries.py). Its biconic adds two
// conics, unlike ours (Zemax's), except for cylinders.
TEST_CASE("sags, intercepts and normals as in optiland's tests") {
  const auto file = shared_data("oracles/optiland_test_assertions.json");
  if (!file) return;
  std::ifstream in(*file);
  std::map<std::pair<std::string, std::string>, std::vector<double>> expected;
  const auto assertions = nlohmann::json::parse(in);
  for (const auto& row : assertions["tests"]["tests/test_geometries.py"]) {
    if (row["expected"].is_number())
      expected[{row["test"].get<std::string>(), row["quantity"].get<std::string>()}].push_back(
          row["expected"].get<double>());
  }
  const auto stated = [&](const std::string& test, const char* quantity, std::size_t k = 0) {
    CAPTURE(test);
    const auto& values = expected[{test, quantity}];
    REQUIRE(values.size() > k);
    return values[k];
  };
  const auto sag = [](double radius, const SurfaceShape& shape, double x, double y) {
    return surface_at(radius == 0.0 ? 0.0 : 1.0 / radius, shape, {x, y})->sag_mm;
  };
  static constexpr double kPrinted = 6e-8;  // some of seven decimals; sag(10, 1) is 20 - sqrt(399) less 1.3e-8 there
  const auto same = [](double value, double wanted) { CHECK(std::abs(value - wanted) < kPrinted); };

  same(sag(10, {}, 1, 1), stated("TestStandardGeometry.test_sag_sphere", "geometry.sag(1, 1)"));
  same(sag(10, {}, -2, 3), stated("TestStandardGeometry.test_sag_sphere", "geometry.sag(-2, 3)"));
  same(sag(25, even_asphere(-1, {}), 2.1, -1.134),
       stated("TestStandardGeometry.test_sag_parabola", "geometry.sag(2.1, -1.134)"));
  same(sag(25, even_asphere(-1, {}), 5, 5), stated("TestStandardGeometry.test_sag_parabola", "geometry.sag(5, 5)"));
  same(sag(27, even_asphere(0.55, {}), 3.1, -3.134),
       stated("TestStandardGeometry.test_sag_conic", "geometry.sag(3.1, -3.134)"));
  same(sag(27, even_asphere(0.55, {}), 2, 5), stated("TestStandardGeometry.test_sag_conic", "geometry.sag(2, 5)"));
  const SurfaceShape even = even_asphere(0, {0, 1e-3, 0, -1e-5}), odd = even_asphere(0, {1e-3, -1e-5});
  same(sag(27, even, 1, 1), stated("TestEvenAsphere.test_sag", "geometry.sag(1, 1)"));
  same(sag(27, even, -2, 3), stated("TestEvenAsphere.test_sag", "geometry.sag(-2, 3)"));
  same(sag(27, odd, 1, 1), stated("TestOddAsphere.test_sag", "geometry.sag(1, 1)"));
  same(sag(27, odd, -2, 3), stated("TestOddAsphere.test_sag", "geometry.sag(-2, 3)"));
  for (const ShapeKind kind : {ShapeKind::Toroid, ShapeKind::Biconic}) {
    const SurfaceShape in_y{.kind = kind}, in_x{.kind = kind, .curvature_x_per_mm = 0.1};
    same(sag(20, in_y, 10, 1), stated("TestBiconicGeometry.test_sag_rx_infinite", "geom.sag(x=10, y=1)"));
    same(sag(20, in_y, -5, 1), stated("TestBiconicGeometry.test_sag_rx_infinite", "geom.sag(x=-5, y=1)"));
    same(sag(0, in_x, 1, 10), stated("TestBiconicGeometry.test_sag_ry_infinite", "geom.sag(x=1, y=10)"));
    const Vec2 slope = surface_at(0.1, in_y, {0.3, 1.0})->slope;
    CHECK(slope.x == 0.0);
    same(slope.y / std::hypot(1.0, slope.y),
         stated("TestBiconicGeometry.test_surface_normal_cylindrical_rx_inf", "ny"));
  }
  // The normals' z is negative there.
  const auto normal = [&](const char* test, const SurfaceShape& shape) {
    const Vec2 slope = surface_at(0.1, shape, {1, 2})->slope;
    const double fraction = 1.0 / std::sqrt(1.0 + dot(slope, slope));
    same(slope.x * fraction, stated(test, "nx"));
    same(slope.y * fraction, stated(test, "ny"));
    same(-fraction, stated(test, "nz"));
  };
  normal("TestStandardGeometry.test_surface_normal", even_asphere(0.5, {}));
  normal("TestEvenAsphere.test_surface_normal", even_asphere(0.5, {0, 1e-2}));
  normal("TestOddAsphere.test_surface_normal", even_asphere(0.5, {1e-2, -1e-5}));
  const auto distance = [](Vec3 from, Vec3 along) {
    return length(meet(-1.0 / 12, even_asphere(0.5, {}), {from, along}).steps.at(0).position_mm - from);
  };
  same(distance({1, 2, -3}, {0, 0, 1}), stated("TestStandardGeometry.test_distance", "distance", 0));
  same(distance({1, 2, -10.2}, {0.359, -0.229, std::sqrt(1 - 0.359 * 0.359 - 0.229 * 0.229)}),
       stated("TestStandardGeometry.test_distance", "distance", 1));
}

TEST_CASE("slopes are the sag's differences") {
  std::mt19937 random(5);
  std::uniform_real_distribution<> any(-7.0, 7.0);
  constexpr double kStep = 1e-5;
  for (const auto& [curvature, shape] : any_shapes()) {
    for (int k = 0; k < 50; ++k) {
      const Vec2 at{any(random), any(random)};
      const auto sag = [&](Vec2 step) { return surface_at(curvature, shape, at + step)->sag_mm; };
      const Vec2 slope = surface_at(curvature, shape, at)->slope;
      CHECK(std::abs(slope.x - (sag({kStep, 0}) - sag({-kStep, 0})) / (2 * kStep)) < 1e-8);
      CHECK(std::abs(slope.y - (sag({0, kStep}) - sag({0, -kStep})) / (2 * kStep)) < 1e-8);
    }
  }
}

TEST_CASE("rays end on the surface's formula and are refracted about its normal, from the front or from behind") {
  std::mt19937 random(6);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  for (const auto& [curvature, shape] : any_shapes()) {
    for (int k = 0; k < 300; ++k) {
      const Vec3 through{5.0 * any(random), 5.0 * any(random), 0.0};
      const Vec3 direction = normalized({0.5 * any(random), 0.5 * any(random), 1.0});
      // In half of the cases the start lies behind the surface.
      const RayRecord record = meet(curvature, shape, {through + direction * (20.0 * any(random)), direction});
      REQUIRE(record.ray.status == RayStatus::Ok);
      const Vec3 at = record.steps[0].position_mm;
      const auto point = surface_at(curvature, shape, {at.x, at.y});
      REQUIRE(point.has_value());
      CHECK(std::abs(at.z - point->sag_mm) < 1e-12);
      const Vec3 normal = normalized({-point->slope.x, -point->slope.y, 1.0});
      const Vec3 after = record.steps[0].direction_after;
      const Vec3 kept = direction - 1.6 * after;  // along the normal, by Snell's law
      CHECK(length(kept - normal * dot(kept, normal)) < 1e-11);
      CHECK(std::abs(length(after) - 1.0) < 1e-12);
      CHECK(record.steps[0].angle_of_incidence_rad == test::approx(std::acos(dot(direction, normal))).epsilon(1e-7));
    }
  }
}

// Descartes: a paraboloid's mirror, an ellipsoid from the air, a hyperboloid from the glass.
TEST_CASE("conics that focus a bundle to a point") {
  const double n = 1.6, radius = 40.0;
  for (const double height : {0.1, 3.0, 7.9, 15.0, 30.0}) {
    CAPTURE(height);
    const auto crossing = [](const RayRecord& record) {
      const Vec3 at = record.steps.at(0).position_mm, d = record.steps.at(0).direction_after;
      return at.z - d.z * at.y / d.y;
    };
    OpticalPath mirror = direct_path(one_surface(-1.0 / radius, even_asphere(-1.0, {})), 550.0);
    mirror.steps[0].event = PathEvent::Reflect;
    CHECK(crossing(trace_recorded(mirror, {{0, height, -100}, {0, 0, 1}})) == test::approx(-radius / 2).epsilon(1e-12));
    CHECK(crossing(meet(1.0 / radius, even_asphere(-1 / (n * n), {}), {{0, height, -100}, {0, 0, 1}})) ==
          test::approx(n * radius / (n - 1)).epsilon(1e-12));
    LensState plano = one_surface(-1.0 / radius, even_asphere(-n * n, {}));
    std::swap(plano.surfaces[0].before, plano.surfaces[0].after);
    CHECK(crossing(trace_recorded(direct_path(plano, 550.0), {{0, height, -100}, {0, 0, 1}})) ==
          test::approx(radius / (n - 1)).epsilon(1e-12));
  }
}

TEST_CASE("a surface ends where its root does, and rays beyond are blocked or miss") {
  CHECK_FALSE(surface_at(0.1, even_asphere(1.0, {}), {0.0, 7.2}).has_value());
  CHECK(surface_at(0.1, even_asphere(1.0, {}), {0.0, 7.0}).has_value());
  CHECK_FALSE(surface_at(0.1, toroid(0.05), {0.0, 10.1}).has_value());
  CHECK_FALSE(surface_at(0.0, toroid(0.1), {10.1, 0.0}).has_value());
  for (const SurfaceShape& shape :
       {even_asphere(1.0, {0, 0, 0, 1e-6}), SurfaceShape{.kind = ShapeKind::Biconic, .conic = 1.0}}) {
    const RayRecord beyond = meet(0.1, shape, {{0.0, 9.0, -5.0}, {0, 0, 1}});
    CHECK((beyond.ray.status == RayStatus::Missed || beyond.ray.relative_height > 1.0));
  }
  const double nan = std::nan("");
  CHECK(meet(0.1, even_asphere(0.5, {0, 1e-3}), {{nan, 0, 0}, {0, 0, 1}}).ray.status == RayStatus::NotFinite);
  CHECK(meet(0.1, even_asphere(0.5, {0, 1e300}), {{1, 1, -5}, {0, 0, 1}}).ray.status == RayStatus::Missed);
}

// A coefficient that changes only the way in which the surface is computed.
TEST_CASE("an asphere of no coefficients and a toroid of equal radii are their spheres, ghost by ghost") {
  for (const bool as_toroid : {false, true}) {
    CAPTURE(as_toroid);
    const LensState sphere = bundled("tessar");
    LensState same = sphere;
    for (SurfaceState& s : same.surfaces) {
      if (s.kind == SurfaceKind::Stop) continue;
      s.shape = even_asphere(0.0, {0, 0, 0, 1e-300});
      if (as_toroid)
        s.shape = {.kind = ShapeKind::Toroid, .curvature_x_per_mm = s.curvature_per_mm, .rotation_rad = 0.3};
    }
    CHECK(same.has_axial_symmetry() == !as_toroid);
    CHECK(first_order(same, 550.0).focal_length_x_mm == test::approx(sphere.focal_length_mm).epsilon(1e-3));
    std::mt19937 random(8);
    std::uniform_real_distribution<> any(-1.0, 1.0);
    int unblocked = 0;
    const ReflectanceTables tables(same, 550.0);
    for (int i = 1; i < 7; ++i) {
      for (int j = i + 1; j <= 7; ++j) {
        if (i == sphere.stop_index + 1 || j == sphere.stop_index + 1) continue;
        const OpticalPath path = ghost_path(sphere, {i, j}, 550.0), other = ghost_path(same, {i, j}, 550.0);
        const Vec3 direction = normalized({0.1 * any(random), 0.1, 1.0});
        const PacketPath packets(other, tables, {{0, 0, -5.0}, {direction}});
        std::vector<float> x, y;
        std::vector<TracedRay> expected;
        for (int k = 0; k < 64; ++k) {
          const Vec2 at{static_cast<float>(8.0 * any(random)), static_cast<float>(8.0 * any(random))};
          const Ray ray{{at.x, at.y, -5.0}, direction};
          const TracedRay a = trace(path, ray), b = trace(other, ray);
          if (blocked_by(a, path, Iris{}) > 0.0) continue;
          ++unblocked;
          REQUIRE(b.status == a.status);
          const double scale = std::max(1.0, length(a.sensor_mm));
          CHECK(length(a.sensor_mm - b.sensor_mm) <= 1e-12 * 100.0 * scale);
          CHECK(b.transmission == test::approx(a.transmission).epsilon(1e-11));
          CHECK(b.relative_height == test::approx(a.relative_height).epsilon(1e-12));
          x.push_back(static_cast<float>(at.x));
          y.push_back(static_cast<float>(at.y));
          expected.push_back(a);
        }
        std::vector<float> sx(x.size()), sy(x.size()), t(x.size()), r(x.size()), stop(2 * kMaxStopCrossings * x.size());
        TracedArrays out{sx.data(), sy.data(), t.data(), r.data(), {}, {}, nullptr, 0};
        for (std::size_t c = 0; c < kMaxStopCrossings; ++c) {
          out.stop_x[c] = stop.data() + 2 * c * x.size();
          out.stop_y[c] = stop.data() + (2 * c + 1) * x.size();
        }
        for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
          trace_packets(packets, precision, x.data(), y.data(), x.size(), out);
          const double tolerance = precision == PacketPrecision::Float ? 2e-3 : 2e-5;
          for (std::size_t k = 0; k < x.size(); ++k) {
            CHECK(length(Vec2{sx[k], sy[k]} - expected[k].sensor_mm) <
                  tolerance * std::max(1.0, 0.1 * length(expected[k].sensor_mm)));
            CHECK(t[k] == test::approx(expected[k].transmission).epsilon(1e-3));
          }
        }
      }
    }
    CHECK(unblocked > 200);
  }
}

TEST_CASE("packets of rays meet every surface where single rays do, moved and tilted as well") {
  std::mt19937 random(9);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  for (const bool askew : {false, true}) {
    for (const auto& [curvature, shape] : any_shapes()) {
      LensState lens = one_surface(curvature, shape);
      if (askew) lens.surfaces[0].pose = {{0.3, -0.2, 0.1}, normalized({0.05, -0.08, 1.0})};
      const OpticalPath path = direct_path(lens, 550.0);
      const Vec3 direction = normalized({0.3 * any(random), 0.3 * any(random), 1.0});
      const ReflectanceTables tables(lens, 550.0);
      const PacketPath packets(path, tables, {{0, 0, -5.0}, {direction}});
      std::vector<float> x, y;
      for (int k = 0; k < 37; ++k) {
        x.push_back(static_cast<float>(5.0 * any(random)));
        y.push_back(static_cast<float>(5.0 * any(random)));
      }
      std::vector<float> sx(x.size()), sy(x.size()), t(x.size()), r(x.size());
      const TracedArrays out{sx.data(), sy.data(), t.data(), r.data(), {}, {}, nullptr, 0};
      for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
        trace_packets(packets, precision, x.data(), y.data(), x.size(), out);
        const double tolerance = precision == PacketPrecision::Float ? 2e-4 : 1e-5;
        for (std::size_t k = 0; k < x.size(); ++k) {
          const TracedRay single = trace(path, {{x[k], y[k], -5.0}, direction});
          REQUIRE(single.status == RayStatus::Ok);
          CHECK(length(Vec2{sx[k], sy[k]} - single.sensor_mm) < tolerance);
          CHECK(r[k] == test::approx(single.relative_height).epsilon(1e-4));
          CHECK(t[k] == test::approx(single.transmission).epsilon(1e-4));
        }
      }
    }
  }
}

TEST_CASE("a tilted surface of any shape does what it does in its own frame") {
  const SurfaceShape shape = any_shapes()[0].second;
  const Vec3 axis = normalized({0.0, 0.1, 1.0});  // turned about x: by hand
  LensState askew = one_surface(1.0 / 27, shape);
  askew.surfaces[0].pose = {{0.5, 0.2, 1.0}, axis};
  const auto into = [&](Vec3 v) { return Vec3{v.x, v.y * axis.z - v.z * axis.y, v.y * axis.y + v.z * axis.z}; };
  const Vec3 direction = normalized({0.2, -0.1, 1.0}), from{1.0, 2.0, -7.0};
  const RayRecord found = trace_recorded(direct_path(askew, 550.0), {from, direction});
  const RayRecord own = meet(1.0 / 27, shape, {into(from - Vec3{0.5, 0.2, 1.0}), into(direction)});
  REQUIRE(found.ray.status == RayStatus::Ok);
  CHECK(length(into(found.steps[0].position_mm - Vec3{0.5, 0.2, 1.0}) - own.steps[0].position_mm) < 1e-12);
  CHECK(length(into(found.steps[0].direction_after) - own.steps[0].direction_after) < 1e-13);
}

TEST_CASE("both sections' focal lengths are those of rays close to the axis, and the Schneider's those of the oracle") {
  const LensState lens = bundled("schneider-anamorphic-31");
  const FirstOrder f = first_order(lens, kLineD_nm);
  const double h = 1e-4;
  const auto exit = [&](Vec2 at) {
    return trace(direct_path(lens, kLineD_nm), {{at.x, at.y, 0.0}, {0, 0, 1}}).direction;
  };
  CHECK(-h * exit({0, h}).z / exit({0, h}).y == test::approx(f.focal_length_mm).epsilon(1e-8));
  CHECK(-h * exit({h, 0}).z / exit({h, 0}).x == test::approx(f.focal_length_x_mm).epsilon(1e-8));
  CHECK(std::abs(f.back_focal_distance_mm - f.back_focal_distance_x_mm) < 0.03);  // a common focus
  const auto file = shared_data("oracles/anamorphic_paraxial.json");
  if (!file) return;
  std::ifstream in(*file);
  const auto stated = nlohmann::json::parse(in)["mm"]["2004 schneider US6310731"];
  CHECK(std::abs(f.focal_length_x_mm - stated["power_from_cyl_y_plane"]["efl"].get<double>()) < 6e-4);
  CHECK(std::abs(f.back_focal_distance_x_mm - stated["power_from_cyl_y_plane"]["bfl"].get<double>()) < 6e-4);
  CHECK(std::abs(f.focal_length_mm - stated["other_plane"]["efl"].get<double>()) < 6e-4);
  CHECK(std::abs(f.back_focal_distance_mm - stated["other_plane"]["bfl"].get<double>()) < 6e-4);
}

TEST_CASE("a polynomial's r^2 counts as curvature, and a cylinder at an angle as Euler has it") {
  LensState lens = one_surface(1.0 / 50, even_asphere(0.0, {0, 1e-3, 0, 1e-5}));
  const double power = 0.6 * (1.0 / 50 + 2e-3);
  CHECK(abcd_between(lens.surfaces, 0, 0, 550.0).c == test::approx(-power / 1.6).epsilon(1e-14));
  lens = one_surface(0.0, {.kind = ShapeKind::Toroid, .curvature_x_per_mm = 0.02, .rotation_rad = 0.5});
  CHECK(abcd_between(lens.surfaces, 0, 0, 550.0, Section::X).c ==
        test::approx(-0.6 / 1.6 * 0.02 * std::pow(std::cos(0.5), 2)).epsilon(1e-14));
  CHECK(abcd_between(lens.surfaces, 0, 0, 550.0, Section::Y).c ==
        test::approx(-0.6 / 1.6 * 0.02 * std::pow(std::sin(0.5), 2)).epsilon(1e-14));
}

TEST_CASE("an anamorphic lens's lights land where they are aimed, the squeeze between the two directions") {
  const LensState lens = bundled("schneider-anamorphic-31");
  for (const Vec2 at : {Vec2{}, {3.0, 0.0}, {0.0, 3.0}, {-8.0, 6.0}, {10.0, -9.0}}) {
    CAPTURE(at.x);
    CAPTURE(at.y);
    const Vec3 direction = direction_for_image_point(lens, at, 550.0);
    CHECK(length(chief_ray_image_point(lens, {direction}, 550.0) - at) < 2e-6);
    CHECK(direction.x * at.x >= 0.0);
    CHECK(direction.y * at.y >= 0.0);
  }
  const Vec2 a = chief_ray_image_point(lens, {normalized({0.02, 0.0, 1.0})}, 550.0);
  const Vec2 b = chief_ray_image_point(lens, {normalized({0.0, 0.02, 1.0})}, 550.0);
  CHECK(b.y / a.x == test::approx(60.555 / 31.488).epsilon(0.01));
  const Vec2 far_off = chief_ray_image_point(lens, {normalized({3.0, 2.0, 1.0})}, 550.0);  // beyond any chief ray
  CHECK(std::isfinite(far_off.x + far_off.y));
  CHECK(std::isfinite(direction_for_image_point(lens, {500.0, 300.0}, 550.0).z));
}
