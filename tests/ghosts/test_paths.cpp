// SPDX-License-Identifier: Apache-2.0
// Optical paths other than two reflections within the lens: four reflections, reflections at the sensor, in diffraction
// orders of its pixels, and glass that absorbs.
#include <cmath>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/glass_catalogue.h"
#include "ghosts/wavelengths.h"
#include "optics/trace/packet_trace.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using test::bundled;
using test::kGreen_nm;

namespace {

// Every path by its reflections: at j, i, l, k, with at most max_crossings crossings of the stop.
std::set<std::vector<int>> ways_by_hand(const LensState& lens, int reflections, int max_crossings) {
  const int count = static_cast<int>(lens.surfaces.size()), stop = lens.stop_index + 1;
  std::set<std::vector<int>> found;
  const auto walk = [&](auto&& self, std::vector<int> turns, int at, int direction, int crossings) -> void {
    const bool odd = turns.size() % 2 != 0;
    if (!odd && !turns.empty()) {
      const int last = crossings + (at < stop ? 1 : 0);
      if (last <= max_crossings) found.insert(turns);
    }
    if (static_cast<int>(turns.size()) == reflections) return;
    int crossed = crossings;
    for (int k = at + direction; k >= 1 && k <= count; k += direction) {
      if (k == stop) {
        ++crossed;
        continue;
      }
      std::vector<int> further = turns;
      further.push_back(k);
      self(self, further, k, -direction, crossed);
    }
  };
  walk(walk, {}, 0, +1, 0);
  return found;
}

std::vector<int> turns_of(const Ghost& g) {
  return g.reflects_four_times() ? std::vector{g.j, g.i, g.l, g.k} : std::vector{g.j, g.i};
}

double relative_flux(const LensState& lens, const Ghost& ghost) {
  const GhostMeter meter(lens, kGreen_nm);
  const LightSource on_axis{{0, 0, 1}};
  return meter.measure(ghost, on_axis).flux_mm2 / meter.direct_flux(on_axis);
}

LensSettings with_sensor(double reflectance, int orders = 0) {
  LensSettings settings;
  settings.f_number = 16.0;
  settings.sensor.plates = {{2.0, 3.0, Glass{"", ConstantIndex{1.5}}, {}}};
  settings.sensor.reflectance = reflectance;
  settings.sensor.orders = orders;
  return settings;
}

}  // namespace

TEST_CASE("ghosts of up to four reflections are all the paths there are, in order, each once") {
  const LensState lens = bundled("tessar", {});
  for (const auto& [scope, crossings] : {std::pair{GhostScope::OneSideOfStop, 1}, std::pair{GhostScope::All, 3}}) {
    const auto ghosts = enumerate_ghosts(lens, scope, Reflections::UpToFour);
    CHECK(std::is_sorted(ghosts.begin(), ghosts.end()));
    std::set<std::vector<int>> turns;
    for (const Ghost& ghost : ghosts) {
      turns.insert(turns_of(ghost));
      CHECK(has_ghost(lens, ghost));
      CHECK(ghost_path(lens, ghost, kGreen_nm).stop_crossings <= crossings);
    }
    CHECK(turns.size() == ghosts.size());
    CHECK(turns == ways_by_hand(lens, 4, crossings));
  }
  const int stop = lens.stop_index + 1;
  for (const Ghost& none : {Ghost{0, 3}, Ghost{3, 2}, Ghost{2, 99}, Ghost{2, stop}, Ghost{1, 2, 2, 1},
                            Ghost{3, 5, 1, 2}, Ghost{2, 4, 1, 0}, Ghost{1, 2, 0, 0, {1, 0}}})
    CHECK_FALSE(has_ghost(lens, none));
}

TEST_CASE("a plate sends R^2 of two reflections and R^4 of four") {
  LensState lens = bundled("heliar", {.f_number = 16.0});
  // A filter of index 2 in front: 11 per cent at each face.
  SurfaceState front = lens.surfaces.front();
  front.curvature_per_mm = 0.0;
  front.coating = {};
  SurfaceState back = front;
  front.after = back.before = Glass{"", ConstantIndex{2.0}};
  front.before = back.after = air();
  front.z_mm = -9.0;
  back.z_mm = -6.0;
  lens.surfaces.insert(lens.surfaces.begin(), {front, back});
  lens.stop_index += 2;
  const double r = 1.0 / 9.0;
  CHECK(relative_flux(lens, {1, 2}) / (r * r) == test::approx(1.0).epsilon(1e-3));
  CHECK(relative_flux(lens, {1, 2, 1, 2}) / (r * r * r * r) == test::approx(1.0).epsilon(1e-3));
}

TEST_CASE("matrices of four reflections are those of rays near the axis") {
  const LensState lens = bundled("tessar", {});
  const auto ghosts = enumerate_ghosts(lens, GhostScope::All, Reflections::UpToFour);
  int looked_at = 0;
  for (std::size_t g = 0; g < ghosts.size(); g += 13) {
    const std::string name = ghost_name(ghosts[g]);
    CAPTURE(name);
    constexpr double kHeight_mm = 1e-5;
    const TracedRay ray = trace(ghost_path(lens, ghosts[g], kGreen_nm), {{0, kHeight_mm, 0}, {0, 0, 1}});
    REQUIRE(ray.status == RayStatus::Ok);
    const Abcd m = abcd_ghost(lens, ghosts[g], kGreen_nm);
    CHECK(ray.sensor_mm.y / kHeight_mm == test::approx(m.a).epsilon(1e-6));
    ++looked_at;
  }
  CHECK(looked_at >= 20);
}

TEST_CASE("a plate moves the sensor by t (1 - 1 / n), and too many do not fit") {
  const LensState bare = bundled("heliar", {.f_number = 16.0});
  const LensState covered = bundled("heliar", with_sensor(0.0));
  CHECK(covered.sensor_z_mm - bare.sensor_z_mm == test::approx(2.0 / 3.0).epsilon(1e-9));
  REQUIRE(covered.surfaces.size() == bare.surfaces.size() + 2);
  CHECK(covered.sensor_z_mm - covered.surfaces.back().z_mm == test::approx(3.0).epsilon(1e-9));
  // The sensor is still in focus: a ray close to the axis meets its middle.
  const TracedRay ray = trace(direct_path(covered, kLineD_nm), {{0, 1e-4, 0}, {0, 0, 1}});
  CHECK(std::abs(ray.sensor_mm.y) < 1e-10);
  LensSettings thick = with_sensor(0.0);
  thick.sensor.plates.front().thickness_mm = thick.sensor.plates.front().gap_mm = 99.0;
  const auto lens = find_lens("heliar");
  REQUIRE(lens.has_value());
  const auto refused = configure_lens(*lens, thick);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().message.find("the lens leaves") != std::string::npos);
  for (const double fraction : {-0.1, 1.1, std::nan("")})
    CHECK_FALSE(configure_lens(*lens, with_sensor(fraction)).has_value());
  CHECK_FALSE(configure_lens(*lens, with_sensor(0.1, 99)).has_value());
}

TEST_CASE(
    "light goes from the sensor to a plate and back: its transmittance is R_sensor R (1 - R)^2, then R at the front") {
  const LensState lens = bundled("heliar", with_sensor(0.2));
  const int sensor = static_cast<int>(lens.surfaces.size());
  REQUIRE(lens.surfaces.back().kind == SurfaceKind::Sensor);
  const double r = 0.04;
  // At f/16 angles are small enough.
  CHECK(relative_flux(lens, {sensor - 1, sensor}) / (0.2 * r) == test::approx(1.0).epsilon(2e-3));
  CHECK(relative_flux(lens, {sensor - 2, sensor}) / (0.2 * r * (1 - r) * (1 - r)) == test::approx(1.0).epsilon(2e-3));
  // Twice the direct image's own cone, from a path that is longer by twice the gap.
  const GhostMeasure ghost = GhostMeter(lens, kGreen_nm).measure({sensor - 1, sensor}, LightSource{{0, 0, 1}});
  CHECK(0.5 * (ghost.max_mm.y - ghost.min_mm.y) == test::approx(2.0 * 3.0 / 32.0).epsilon(0.03));
}

TEST_CASE("a sensor holds light within its frame only, and that outside it is not lost to the direct image") {
  const LensState lens = bundled("heliar", with_sensor(0.2));
  const int sensor = static_cast<int>(lens.surfaces.size());
  const GhostMeter meter(lens, kGreen_nm);
  const LensState bare = bundled("heliar", {.f_number = 16.0});
  const auto beyond = [&](double fraction) {
    return LightSource{direction_for_image_point(bare, {0.0, fraction * 0.5 * lens.sensor_height_mm}, kGreen_nm)};
  };
  CHECK(meter.measure({sensor - 1, sensor}, beyond(0.9)).flux_mm2 > 0.0);
  CHECK(meter.measure({sensor - 1, sensor}, beyond(1.1)).flux_mm2 == 0.0);
  CHECK(meter.direct_flux(beyond(1.1)) > 0.9 * meter.direct_flux(beyond(0.9)));
}

TEST_CASE("the sensor's orders land where the grating equation has them, and share the light") {
  LensSettings settings = with_sensor(0.5, 3);
  settings.sensor.pitch_mm = 0.006;
  settings.sensor.fill = 0.7;
  const LensState lens = bundled("heliar", settings);
  const int sensor = static_cast<int>(lens.surfaces.size());
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  CHECK(std::count_if(ghosts.begin(), ghosts.end(),
                      [&](const Ghost& g) { return g.i == sensor - 1 && g.j == sensor; }) == 49);
  const GhostMeter meter(lens, kGreen_nm);
  const LightSource on_axis{{0, 0, 1}};
  const auto measured = [&](int x, int y) { return meter.measure({sensor - 1, sensor, 0, 0, {x, y}}, on_axis); };
  const double none = measured(0, 0).flux_mm2;
  for (const int order : {-3, -1, 1, 2}) {
    CAPTURE(order);
    const GhostMeasure ghost = measured(order, 0);
    // Over the gap of 3 mm and back.
    const double sine = order * kGreen_nm * 1e-6 / 0.006;
    CHECK(ghost.centroid_mm.x == test::approx(6.0 * sine / std::sqrt(1.0 - sine * sine)).epsilon(5e-3));
    CHECK(std::abs(ghost.centroid_mm.y) < 1e-3);
    const double at = 3.14159265358979 * order * 0.7;
    CHECK(ghost.flux_mm2 / none == test::approx(std::pow(std::sin(at) / at, 2.0)).epsilon(0.02));
    CHECK(measured(0, order).flux_mm2 / ghost.flux_mm2 == test::approx(1.0).epsilon(2e-3));
  }
  CHECK(has_ghost(lens, {sensor - 1, sensor, 0, 0, {3, -3}}));
  CHECK_FALSE(has_ghost(lens, {sensor - 1, sensor, 0, 0, {4, 0}}));
  CHECK_FALSE(has_ghost(lens, {1, 2, 0, 0, {1, 0}}));
}

TEST_CASE("orders that leave no direction fail in both tracers") {
  LensSettings settings = with_sensor(0.5, 20);
  settings.sensor.pitch_mm = 0.005;  // the tenth order and more are evanescent
  const LensState lens = bundled("heliar", settings);
  const int sensor = static_cast<int>(lens.surfaces.size());
  const auto status = [&](int order) {
    return trace(ghost_path(lens, {sensor - 1, sensor, 0, 0, {order, 0}}, kGreen_nm), {{0, 0, 0}, {0, 0, 1}}).status;
  };
  CHECK(status(9) == RayStatus::Ok);
  CHECK(status(10) == RayStatus::Missed);
  CHECK(GhostMeter(lens, kGreen_nm).measure({sensor - 1, sensor, 0, 0, {10, 0}}, LightSource{{0, 0, 1}}).flux_mm2 ==
        0.0);
}

TEST_CASE("glass absorbs by the path length in it, in both tracers alike") {
  auto dense = bundled_glasses().find("N-SF66");
  REQUIRE(dense.has_value());
  const double lambda_nm = 420.0;
  const double per_cm = internal_transmittance(dense->glass, lambda_nm, 10.0);
  REQUIRE(per_cm < 0.95);
  LensSettings settings = with_sensor(0.0);
  settings.sensor.plates.front() = {10.0, 3.0, dense->glass, {}};
  const LensState clear = bundled("heliar", settings);
  settings.absorption = true;
  const LensState dark = bundled("heliar", settings);
  const Ray askew{{0.5, 1.0, 0.0}, normalized({0.02, 0.3, 1.0})};
  // The Heliar's own glasses have no catalogue data: only the plate absorbs.
  const auto traced = [&](const LensState& lens) { return trace_recorded(direct_path(lens, lambda_nm), askew); };
  const RayRecord way = traced(dark);
  REQUIRE(way.ray.status == RayStatus::Ok);
  const std::size_t last = way.steps.size() - 1;
  const double length_mm = length(way.steps[last].position_mm - way.steps[last - 1].position_mm);
  CHECK(length_mm > 10.05);
  CHECK(way.ray.transmission / traced(clear).ray.transmission ==
        test::approx(std::pow(per_cm, length_mm / 10.0)).epsilon(1e-9));

  const ReflectanceTables tables(dark, lambda_nm);
  const OpticalPath path = direct_path(dark, lambda_nm);
  const PacketPath packets(path, tables, {askew.origin_mm, {askew.direction}});
  for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
    const float zero = 0.0F;
    float x = 0, y = 0, transmission = 0, relative_height = 0, stop_x = 0, stop_y = 0;
    TracedArrays out{&x, &y, &transmission, &relative_height, {&stop_x}, {&stop_y}, nullptr, 0};
    trace_packets(packets, precision, &zero, &zero, 1, out);
    CHECK(transmission == test::approx(way.ray.transmission).epsilon(1e-4));
  }
}
