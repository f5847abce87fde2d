// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <hwy/targets.h>

#include "optics/trace/lens_steps.h"
#include "optics/trace/packet_trace.h"
#include "render/bundle/scene.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

struct Batch {
  explicit Batch(std::size_t count) : columns(10, std::vector<float>(count)) {}

  [[nodiscard]] TracedArrays arrays() {
    const auto at = [&](std::size_t k) { return columns[k].data(); };
    return {at(0), at(1), at(2), at(3), {at(4), at(5), at(6)}, {at(7), at(8), at(9)}};
  }
  std::vector<std::vector<float>> columns;
};

// Points over the unblocked region of a ghost.
struct Fan {
  LightRays rays;
  std::vector<float> x_mm, y_mm;

  [[nodiscard]] Ray ray(std::size_t k) const {
    return {{rays.origin_mm.x + x_mm[k], rays.origin_mm.y + y_mm[k], rays.origin_mm.z}, rays.source.direction};
  }
};

Fan fan_over(Vec2 low, Vec2 high, double z_mm, Vec3 direction, int side) {
  Fan fan;
  fan.rays = {{low.x, low.y, z_mm}, direction};
  for (int k = 0; k < side * side; ++k) {
    fan.x_mm.push_back(static_cast<float>((high.x - low.x) * (k % side) / (side - 1)));
    fan.y_mm.push_back(static_cast<float>((high.y - low.y) * (k / side) / (side - 1)));
  }
  return fan;
}

struct Worst {
  double point_mm = 0, transmission = 0, stop = 0, relative_height = 0;
  int rays = 0;
};

// The largest differences from trace() over the rays that get through.
Worst compare(const OpticalPath& path, const LensState& lens, const ReflectanceTables& tables, const Fan& fan,
              PacketPrecision precision) {
  Batch batch(fan.x_mm.size());
  trace_packets(PacketPath(path, tables, fan.rays), precision, fan.x_mm.data(), fan.y_mm.data(), fan.x_mm.size(),
                batch.arrays());
  Worst worst;
  for (std::size_t k = 0; k < fan.x_mm.size(); ++k) {
    const TracedRay ray = trace(path, fan.ray(k));
    if (ray.status != RayStatus::Ok || blocked_by(ray, path, lens.iris) > 0.0) continue;
    const auto& c = batch.columns;
    ++worst.rays;
    worst.point_mm = std::max(worst.point_mm, std::hypot(c[0][k] - ray.sensor_mm.x, c[1][k] - ray.sensor_mm.y));
    worst.transmission = std::max(worst.transmission, std::abs(c[2][k] / ray.transmission - 1.0));
    worst.relative_height = std::max(worst.relative_height, std::abs(c[3][k] - ray.relative_height));
    for (std::size_t s = 0; s < static_cast<std::size_t>(path.stop_crossings); ++s) {
      worst.stop = std::max(worst.stop, std::hypot(c[4 + s][k] - ray.stop[s].x, c[7 + s][k] - ray.stop[s].y));
    }
  }
  return worst;
}

// Interpolates between the nodes as look_up() does.
double interpolated(const float* table, double u) {
  const double position = u * ReflectanceTables::kIntervals;
  const int k = std::min(static_cast<int>(position), ReflectanceTables::kIntervals - 1);
  return std::lerp(static_cast<double>(table[k]), static_cast<double>(table[k + 1]), position - k);
}

LensState one_surface(const Coating& coating, double n) {
  LensState lens;
  lens.surfaces = {{SurfaceKind::Refracting, 0.0, 0.0, 10.0, air(), {"", ConstantIndex{n}}, coating}};
  return lens;
}

}  // namespace

TEST_CASE("packets land where single rays in double do, on every instruction set of this machine") {
  const LensState lens = test::lens("canon-70-200", 32.0, 200.0);
  const Vec3 direction = normalized({-0.03, -0.02, 1.0});
  const ReflectanceTables tables(lens, 550.0);
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  for (std::size_t g = 0; g < ghosts.size(); g += 23) {
    CAPTURE(ghosts[g].i);
    CAPTURE(ghosts[g].j);
    const OpticalPath path = ghost_path(lens, ghosts[g], 550.0);
    const EntranceWindow window = entrance_window(lens, direction);
    const pupils::Pupil pupil =
        find_pupil(pupils::PupilRays(path, tables, direction, IrisShape(lens.iris), window), {});
    if (pupil.is_empty()) continue;
    const Fan fan = fan_over(pupil.box().low, pupil.box().high, window.z_mm, direction, 19);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      CAPTURE(hwy::TargetName(target));
      const Worst single = compare(path, lens, tables, fan, PacketPrecision::Float);
      const Worst fine = compare(path, lens, tables, fan, PacketPrecision::Double);
      CHECK(single.rays > 100);
      CHECK(single.point_mm < 1e-3);
      CHECK(single.transmission < 1e-4);
      CHECK(single.relative_height < 1e-4);
      CHECK(single.stop < 1e-3);
      CHECK(fine.point_mm < 1e-5);
      CHECK(fine.transmission < 1e-4);
      CHECK(fine.stop < 1e-5);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("rays that fail are infinitely far beyond a rim, on every instruction set of this machine") {
  const LensState lens = test::lens("heliar", 16.0);
  const Vec3 direction = normalized({0.21, 0.0, 1.0});
  const ReflectanceTables tables(lens, 550.0);
  const OpticalPath path = ghost_path(lens, {1, 5}, 550.0);
  const Fan fan = fan_over({-14.0, -8.0}, {0.0, 8.0}, entrance_window(lens, direction).z_mm, direction, 19);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    CAPTURE(hwy::TargetName(target));
    for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
      Batch batch(fan.x_mm.size());
      trace_packets(PacketPath(path, tables, fan.rays), precision, fan.x_mm.data(), fan.y_mm.data(), fan.x_mm.size(),
                    batch.arrays());
      int failing = 0;
      for (std::size_t k = 0; k < fan.x_mm.size(); ++k) {
        const bool fails = trace(path, fan.ray(k)).status != RayStatus::Ok;
        failing += fails ? 1 : 0;
        CHECK(std::isinf(batch.columns[3][k]) == fails);
      }
      CHECK(failing > 50);
      CHECK(failing < 300);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("a path that crosses the stop three times tells all three crossings") {
  const LensState lens = test::lens("heliar", 16.0);
  const Ghost across{3, 9};  // reflects behind the stop, then before it
  const OpticalPath path = ghost_path(lens, across, 550.0);
  REQUIRE(path.stop_crossings == 3);
  const ReflectanceTables tables(lens, 550.0);
  const Fan fan = fan_over({-1.0, -1.0}, {1.0, 1.0}, -1.0, {0.0, 0.0, 1.0}, 21);
  LensState open = lens;  // all rays that meet no rim are compared
  OpticalPath wide = path;
  wide.stop_radius_mm = 100.0;
  open.iris = {};
  const Worst worst = compare(wide, open, tables, fan, PacketPrecision::Float);
  CHECK(worst.rays > 100);
  CHECK(worst.stop < 1e-5);
  CHECK(worst.point_mm < 1e-3);
}

TEST_CASE("any number of rays gives each ray the same result") {
  const LensState lens = test::lens("heliar", 16.0);
  const OpticalPath path = ghost_path(lens, {3, 4}, 550.0);
  const ReflectanceTables tables(lens, 550.0);
  const Fan fan = fan_over({-4.0, -4.0}, {4.0, 4.0}, -5.0, {0.0, 0.0, 1.0}, 32);
  const PacketPath packets(path, tables, fan.rays);
  for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
    Batch all(fan.x_mm.size());
    trace_packets(packets, precision, fan.x_mm.data(), fan.y_mm.data(), fan.x_mm.size(), all.arrays());
    for (const std::size_t count : {0, 1, 3, 15, 16, 17, 100}) {
      Batch some(count + 1);
      for (auto& column : some.columns) column[count] = -77.0F;
      trace_packets(packets, precision, fan.x_mm.data(), fan.y_mm.data(), count, some.arrays());
      for (std::size_t c = 0; c < 5; ++c) {
        CHECK(std::equal(some.columns[c].begin(), some.columns[c].end() - 1, all.columns[c].begin()));
        CHECK(some.columns[c][count] == -77.0F);  // nothing is written beyond the end
      }
    }
  }
}

TEST_CASE("rays that fail are flagged as the scalar tracer flags them") {
  const LensState lens = test::lens("heliar", 16.0);
  const ReflectanceTables tables(lens, 550.0);
  const Vec3 direction = normalized({-0.4, -0.3, 1.0});
  const Fan fan = fan_over({-60.0, -60.0}, {60.0, 60.0}, 0.0, direction, 64);
  int failed = 0;
  int differ = 0;
  for (const Ghost ghost : {Ghost{1, 2}, Ghost{2, 5}, Ghost{7, 9}}) {
    const OpticalPath path = ghost_path(lens, ghost, 550.0);
    Batch batch(fan.x_mm.size());
    trace_packets(PacketPath(path, tables, fan.rays), PacketPrecision::Double, fan.x_mm.data(), fan.y_mm.data(),
                  fan.x_mm.size(), batch.arrays());
    for (std::size_t k = 0; k < fan.x_mm.size(); ++k) {
      const bool fails = trace(path, fan.ray(k)).status != RayStatus::Ok;
      failed += fails ? 1 : 0;
      differ += fails != std::isinf(batch.columns[3][k]) ? 1 : 0;
      CHECK(std::isfinite(batch.columns[0][k] + batch.columns[1][k] + batch.columns[2][k]));
      if (fails) CHECK(batch.columns[2][k] == 0.0F);
    }
  }
  CHECK(failed > 1000);
  CHECK(differ == 0);
}

TEST_CASE("tabulated coatings are within 1e-5 of the exact ones, from both sides, at any angle") {
  const Coating bare;
  const Coating quarter{"", QuarterWave{}};
  const Coating stack{"", FilmStack{{{{1.38, 0.0}, 99.6}, {{2.05, 0.0}, 134.1}, {{1.63, 0.0}, 84.4}}}};
  const Coating absorbing{"", FilmStack{{{{1.5, 0.05}, 80.0}, {{2.0, 0.01}, 60.0}}}};
  for (const Coating& coating : {bare, quarter, stack, absorbing}) {
    CAPTURE(describe(coating));
    for (const double n : {1.5168, 1.85}) {
      const LensState lens = one_surface(coating, n);
      const ReflectanceTables tables(lens, 480.0);
      double worst = 0.0;
      for (int k = 0; k < 3777; ++k) {
        const double u = (k + 0.5) / 3777.0;  // cosine in air
        const double inside = std::sqrt(1.0 - (1.0 - u * u) / (n * n));
        const auto& entry = tables.of(0);
        const auto table = [&](int offset) { return interpolated(tables.values() + offset, u); };
        worst = std::max(worst, std::abs(table(entry.reflectance[0]) - reflectance(coating, 1.0, n, u, 480.0)));
        worst = std::max(worst, std::abs(table(entry.reflectance[1]) - reflectance(coating, n, 1.0, inside, 480.0)));
        const double through =
            entry.transmittance >= 0 ? table(entry.transmittance) : 1.0 - table(entry.reflectance[0]);
        worst = std::max(worst, std::abs(through - transmittance(coating, 1.0, n, u, 480.0)));
        worst = std::max(worst, std::abs(through - transmittance(coating, n, 1.0, inside, 480.0)));
      }
      CHECK(worst < 1e-5);
    }
  }
}

namespace {

// Lenses with every kind of step.
std::vector<LensState> lenses_of_all_kinds() {
  std::vector<LensState> lenses;
  const auto add = [&](const char* name, const LensSettings& settings) -> LensState& {
    const auto prescription = find_lens(name);
    REQUIRE(prescription.has_value());
    const auto state = configure_lens(*prescription, settings);
    REQUIRE(state.has_value());
    return lenses.emplace_back(*state);
  };
  LensSettings plain;
  plain.f_number = 8.0;
  add("heliar", plain);
  add("canon-rf-50", plain);  // aspheres
  LensSettings crooked = plain;
  crooked.build = {0.01, 0.2, 5};
  crooked.absorption = true;
  add("heliar", crooked);
  LensSettings sensor = plain;
  sensor.sensor.plates.emplace_back().thickness_mm = 2.0;
  sensor.sensor.reflectance = 0.1;
  sensor.sensor.orders = 1;
  add("heliar", sensor);
  LensState& rims = add("planar-50", plain);
  rims.surfaces[1].aperture = {ApertureKind::Rectangle, {9.0, 7.0}, {0.5, -0.3}, 0.3};
  rims.surfaces[3].aperture = {ApertureKind::Ellipse, {9.0, 8.0}, {0.1, 0.2}, 0.5};
  rims.surfaces[4].obscuration = {{1.0, 2.0}, {0.2, 0.1}, 0.4};
  return lenses;
}

bool same(const PacketStep& a, const PacketStep& b) {
  return a.event == b.event && a.crossing == b.crossing && a.from_denser == b.from_denser &&
         a.reflectance == b.reflectance && a.transmittance == b.transmittance && a.direction == b.direction &&
         a.gap_mm == b.gap_mm && a.curvature_per_mm == b.curvature_per_mm &&
         a.inverse_semi_diameter_per_mm == b.inverse_semi_diameter_per_mm &&
         a.inverse_semi_diameter_squared == b.inverse_semi_diameter_squared && a.eta == b.eta &&
         (a.shape == nullptr) == (b.shape == nullptr) && a.axis == b.axis && a.offset_mm == b.offset_mm &&
         a.rim.coordinates({1.0, 2.0}) == b.rim.coordinates({1.0, 2.0}) && a.blocks_within == b.blocks_within &&
         a.absorption_per_mm == b.absorption_per_mm && a.grating_shift == b.grating_shift &&
         a.efficiency == b.efficiency;
}

}  // namespace

TEST_CASE("paths put together from a lens's steps are those of the ghosts' paths") {
  const LightRays rays{{1.0, 2.0, -3.0}, normalized({0.1, -0.05, 1.0})};
  const std::vector<float> x_mm{0.0F, 1.0F, -2.0F, 3.0F}, y_mm{0.0F, -1.0F, 0.5F, 2.0F};
  std::size_t of_shapes = 0, general = 0, with_order = 0, of_four = 0;
  for (const LensState& lens : lenses_of_all_kinds()) {
    CAPTURE(lens.name);
    const ReflectanceTables tables(lens, 480.0);
    const LensSteps steps(lens, tables);
    const auto ghosts = enumerate_ghosts(lens, GhostScope::All, Reflections::UpToFour);
    for (std::size_t g = 0; g < ghosts.size(); g += 1 + ghosts.size() / 200) {
      CAPTURE(g);
      OpticalPath path = ghost_path(lens, ghosts[g], 480.0);
      path.stop_radius_mm *= 1.5;
      const PacketPath plain(path, tables, rays), quick(steps, ghosts[g], rays, 1.5);
      REQUIRE(plain.steps().size() == quick.steps().size());
      CHECK(std::ranges::equal(plain.steps(), quick.steps(), same));
      CHECK(plain.geometry() == quick.geometry());
      CHECK(plain.stop_crossings() == quick.stop_crossings());
      CHECK(plain.sensor_gap_mm() == quick.sensor_gap_mm());
      CHECK(plain.sensor_offset_mm() == quick.sensor_offset_mm());
      CHECK(plain.inverse_stop_radius_per_mm() == test::approx(quick.inverse_stop_radius_per_mm()).epsilon(1e-14));
      Batch one(x_mm.size()), other(x_mm.size());
      for (auto [of, batch] : {std::pair(&plain, &one), std::pair(&quick, &other)})
        trace_packets(*of, PacketPrecision::Double, x_mm.data(), y_mm.data(), x_mm.size(), batch->arrays());
      CHECK(one.columns[2] == other.columns[2]);
      CHECK(one.columns[3] == other.columns[3]);
      of_shapes += plain.geometry() == PathGeometry::Shapes ? 1 : 0;
      general += plain.geometry() == PathGeometry::General ? 1 : 0;
      with_order += ghosts[g].order != std::array<int, 2>{0, 0} ? 1 : 0;
      of_four += ghosts[g].reflects_four_times() ? 1 : 0;
    }
  }
  CHECK(std::min({of_shapes, general, with_order, of_four}) > 10);
}
