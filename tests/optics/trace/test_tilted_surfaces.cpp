// SPDX-License-Identifier: Apache-2.0
// Decentred and tilted surfaces: against rays rotated into the surface's own frame and back, and first-order theory.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/trace.h"
#include "optics/trace/height_vector.h"
#include "optics/trace/packet_trace.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// Rows of the matrix that rotates the surface's axis to +z.
struct Turn {
  Vec3 x, y, z;
  explicit Turn(Vec3 axis) : z(axis) {
    x = normalized(Vec3{1, 0, 0} - axis * axis.x);
    y = {axis.y * x.z - axis.z * x.y, axis.z * x.x - axis.x * x.z, axis.x * x.y - axis.y * x.x};
  }
  [[nodiscard]] Vec3 into(Vec3 v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
  [[nodiscard]] Vec3 back(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
};

PathStep surface(double curvature, PathEvent event) {
  PathStep step;
  step.event = event;
  step.z_mm = 4.0;
  step.curvature_per_mm = curvature;
  step.semi_diameter_mm = 10.0;
  step.n_out = 1.6;
  return step;
}

OpticalPath path_of(const PathStep& step, bool centred) {
  OpticalPath path;
  path.steps = {step};
  path.sensor_z_mm = 50.0;
  path.centred = centred;
  return path;
}

double glass_relative_height(const LensState& lens, Vec2 at) {
  return trace(direct_path(lens, 550.0), {{at.x, at.y, -1.0}, {0, 0, 1}}).relative_height;
}

}  // namespace

TEST_CASE("a ray at a tilted, decentred sphere or plane does what it does there in the surface's own frame") {
  std::mt19937 random(3);
  std::uniform_real_distribution<> any(-1.0, 1.0);
  for (const double curvature : {0.0, 1.0 / 30.0, -1.0 / 17.0}) {
    for (int k = 0; k < 200; ++k) {
      PathStep askew = surface(curvature, PathEvent::Refract);
      askew.pose.shift_mm = {any(random), any(random), 0.3 * any(random)};
      askew.pose.axis = normalized({0.2 * any(random), 0.2 * any(random), 1.0});
      const Ray ray{{5.0 * any(random), 5.0 * any(random), -3.0},
                    normalized({0.3 * any(random), 0.3 * any(random), 1.0})};
      const Vec3 vertex = askew.pose.shift_mm + Vec3{0, 0, 4.0};

      const Turn rotation(askew.pose.axis);
      PathStep own = surface(curvature, PathEvent::Refract);
      own.z_mm = 0.0;
      const RayRecord expected =
          trace_recorded(path_of(own, true), {rotation.into(ray.origin_mm - vertex), rotation.into(ray.direction)});
      const RayRecord found = trace_recorded(path_of(askew, false), ray);
      REQUIRE(expected.ray.status == RayStatus::Ok);
      REQUIRE(found.ray.status == RayStatus::Ok);
      const Vec3 position = rotation.back(expected.steps[0].position_mm) + vertex;
      const Vec3 direction = rotation.back(expected.steps[0].direction_after);
      CHECK(length(found.steps[0].position_mm - position) < 1e-11);
      CHECK(length(found.steps[0].direction_after - direction) < 1e-13);
      CHECK(found.ray.transmission == test::approx(expected.ray.transmission).epsilon(1e-12));
      CHECK(found.ray.relative_height == test::approx(expected.ray.relative_height).epsilon(1e-11));
      CHECK(length(height_vector(askew, found.steps[0].position_mm)) / 10.0 ==
            test::approx(found.ray.relative_height).epsilon(1e-11));
    }
  }
}

TEST_CASE("a path that is said to be tilted but is not gives what a centred one does") {
  const LensState lens = test::bundled("heliar");
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) {
    OpticalPath path = ghost_path(lens, ghost, 550.0);
    const Ray ray{{1.0, -0.7, -2.0}, normalized({0.05, 0.08, 1.0})};
    const TracedRay expected = trace(path, ray);
    path.centred = false;
    const TracedRay found = trace(path, ray);
    REQUIRE(found.status == expected.status);
    if (found.status != RayStatus::Ok) continue;
    CHECK(length(found.sensor_mm - expected.sensor_mm) < 1e-8);
    CHECK(found.transmission == test::approx(expected.transmission).epsilon(1e-9));
  }
}

TEST_CASE("packets of a lens with errors are the double tracer's rays") {
  const LensState lens =
      test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 8.0, .build = {0.002, 0.1, 5}});
  CHECK_FALSE(lens.has_axial_symmetry());
  const ReflectanceTables tables(lens, 550.0);
  for (const Ghost& ghost : {Ghost{1, 2}, Ghost{3, 9}, Ghost{20, 30}}) {
    const OpticalPath path = ghost_path(lens, ghost, 550.0);
    for (const LightSource& light :
         {LightSource(normalized({0.02, -0.03, 1.0})), LightSource(normalized({0.02, -0.03, 1.0}), 700.0)}) {
      const PacketPath packets(path, tables, {{-4.0, -3.0, 0.0}, light});
      std::array<float, 37> x{}, y{};
      std::array<std::array<float, 37>, 10> out{};
      for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = 0.2F * static_cast<float>(k);
        y[k] = 0.1F * static_cast<float>(k % 7);
      }
      trace_packets(packets, PacketPrecision::Double, x.data(), y.data(), x.size(),
                    {out[0].data(),
                     out[1].data(),
                     out[2].data(),
                     out[3].data(),
                     {out[4].data(), out[5].data(), out[6].data()},
                     {out[7].data(), out[8].data(), out[9].data()},
                     nullptr,
                     0});
      for (std::size_t k = 0; k < x.size(); ++k) {
        const Vec3 from{x[k] - 4.0, y[k] - 3.0, 0.0};
        const TracedRay ray = trace(path, {from, light.direction_at(from)});
        if (ray.status != RayStatus::Ok || ray.relative_height > 1.5) continue;
        CHECK(out[0][k] == test::approx(ray.sensor_mm.x).epsilon(1e-5));
        CHECK(out[1][k] == test::approx(ray.sensor_mm.y).epsilon(1e-5));
        CHECK(out[2][k] == test::approx(ray.transmission * light.flux_at(from)).epsilon(2e-4));
        CHECK(out[3][k] == test::approx(ray.relative_height).epsilon(1e-5));
        CHECK(out[4][k] == test::approx(ray.stop[0].x).epsilon(1e-5));
        CHECK(out[7][k] == test::approx(ray.stop[0].y).epsilon(1e-5));
      }
    }
  }
}

TEST_CASE("a ball moved to a side moves its ghost as its matrix says") {
  Prescription ball;
  ball.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 20.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.1, 20.0, 9.0, {"", ConstantIndex{1.5}}, {}, 0},
                   {SurfaceKind::Refracting, -0.1, 0.0, 9.0, air(), {}, 0}};
  LensState lens = test::configured(ball, 0.5);
  lens.sensor_z_mm = 30.0;
  const double a = abcd_ghost(lens, Ghost{2, 3}, 550.0).a;
  const double offset_mm = 1e-3;
  for (SurfaceState& s : lens.surfaces)
    if (s.kind == SurfaceKind::Refracting) s.pose.shift_mm = {offset_mm, -2.0 * offset_mm, 0.0};
  const TracedRay ray = trace(ghost_path(lens, {2, 3}, 550.0), {{0, 0, -5}, {0, 0, 1}});
  CHECK(ray.sensor_mm.x == test::approx(offset_mm * (1.0 - a)).epsilon(1e-4));
  CHECK(ray.sensor_mm.y == test::approx(-2.0 * offset_mm * (1.0 - a)).epsilon(1e-4));
  // Its rim moves with it.
  CHECK(glass_relative_height(lens, {offset_mm, -2.0 * offset_mm}) < 1e-9);
}

TEST_CASE("build errors: bodies move as wholes, the stop stays, sizes are what was asked for") {
  const LensState ideal = test::bundled("heliar");
  CHECK(ideal.has_axial_symmetry());
  const LensState none = test::bundled("heliar", {.build = {0.0, 0.0, 9}});
  CHECK(none.has_axial_symmetry());
  double tilts = 0.0, ways = 0.0;
  int bodies = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const LensState lens = test::bundled("heliar", {.build = {0.003, 0.05, seed}});
    CHECK(lens.surfaces[static_cast<std::size_t>(lens.stop_index)].is_centred());
    for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
      const SurfaceState& s = lens.surfaces[k];
      CHECK(s.z_mm == ideal.surfaces[k].z_mm);
      if (is_air(s.after) || s.kind == SurfaceKind::Stop) continue;
      // The distance to the next vertex of the same glass, along the common axis, is unchanged.
      const SurfaceState& next = lens.surfaces[k + 1];
      CHECK(next.pose.axis == s.pose.axis);
      const Vec3 way = next.pose.shift_mm - s.pose.shift_mm + Vec3{0, 0, next.z_mm - s.z_mm};
      CHECK(length(way - s.pose.axis * (next.z_mm - s.z_mm)) < 1e-12);
      if (k > 0 && !is_air(lens.surfaces[k - 1].after)) continue;
      ++bodies;
      tilts += std::pow(std::hypot(s.pose.axis.x, s.pose.axis.y), 2.0);
      std::size_t last = k;
      while (!is_air(lens.surfaces[last].after)) ++last;
      const Vec3 middle = (s.pose.shift_mm + lens.surfaces[last].pose.shift_mm) * 0.5;
      ways += std::pow(std::hypot(middle.x, middle.y), 2.0);
    }
  }
  CHECK(bodies == 200 * 3);  // two cemented pairs and a single lens
  CHECK(std::sqrt(tilts / bodies) == test::approx(0.003).epsilon(0.08));
  CHECK(std::sqrt(ways / bodies) == test::approx(0.05).epsilon(0.08));
  const auto heliar = find_lens("heliar");
  for (const BuildErrors& wrong : {BuildErrors{-0.1, 0, 0}, BuildErrors{0.3, 0, 0}, BuildErrors{0, std::nan(""), 0},
                                   BuildErrors{0, -1, 0}, BuildErrors{0, 1e9, 0}})
    CHECK_FALSE(configure_lens(*heliar, {.build = wrong}).has_value());
}

TEST_CASE("lights land and are found again through a lens with errors") {
  const LensState lens = test::bundled("heliar", {.build = {0.005, 0.2, 3}});
  const LensState ideal = test::bundled("heliar");
  for (const double distance_mm : {1e12, 600.0}) {
    for (const Vec2 p : {Vec2{0, 0}, Vec2{3, -2}, Vec2{-15, 10}}) {
      const Vec3 d = direction_for_image_point(lens, p, kLineD_nm, distance_mm);
      const Vec2 back = chief_ray_image_point(lens, {d, distance_mm}, kLineD_nm);
      CHECK(length(back - p) < 1e-5);
      CHECK(length(chief_ray_image_point(ideal, {d, distance_mm}, kLineD_nm) - p) > 1e-3);
    }
  }
}
