// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "render/ray_maps/ghost_scene.h"
#include "render/ray_maps/patch.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::ray_maps;

namespace {

// The value of a field of a patch at u, v in -1..1, directly by Lagrange's formula.
double value_at(const Patch& patch, int field, Vec2 uv) {
  const auto n = static_cast<std::size_t>(patch.nodes);
  std::vector<double> nodes;
  for (std::size_t k = 0; k < n; ++k)
    nodes.push_back(-std::cos(std::acos(-1.0) * static_cast<double>(k) / (patch.nodes - 1)));
  const auto basis = [&](std::size_t k, double x) {
    double product = 1.0;
    for (std::size_t j = 0; j < n; ++j) {
      if (j != k) product *= (x - nodes[j]) / (nodes[k] - nodes[j]);
    }
    return product;
  };
  double sum = 0.0;
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = 0; column < n; ++column) {
      sum += basis(row, uv.y) * basis(column, uv.x) * patch.field(field)[row * n + column];
    }
  }
  return sum;
}

Vec2 entrance_at(const Rectangle& box, Vec2 uv) {
  return {box.low.x + 0.5 * (uv.x + 1.0) * (box.high.x - box.low.x),
          box.low.y + 0.5 * (uv.y + 1.0) * (box.high.y - box.low.y)};
}

// The square of the relative height at every surface but the stop.
std::vector<double> rims_squared(const test::GhostScene& scene, const RayRecord& record) {
  std::vector<double> out;
  for (std::size_t k = 0; k < record.steps.size(); ++k) {
    if (record.steps[k].event == PathEvent::Stop) continue;
    const Vec3 p = record.steps[k].position_mm;
    const double semi_diameter_mm = scene.path.steps[k].semi_diameter_mm;
    out.push_back((p.x * p.x + p.y * p.y) / (semi_diameter_mm * semi_diameter_mm));
  }
  return out;
}

// The error of a patch at points where no ray was traced.
PatchError measured_error(const test::GhostScene& scene, const LobattoRays& ray_set, const Patch& patch,
                          const Frame& frame, const Rgb& gain) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  PatchError worst;
  double largest = 0.0;
  for (int k = 0; k < 60; ++k) {
    const Vec2 uv{coordinate(random), coordinate(random)};
    const RayRecord record = scene.exact(entrance_at(ray_set.box, uv));
    REQUIRE(record.ray.status == RayStatus::Ok);
    const Vec2 p = frame.pixel_from_sensor(record.ray.sensor_mm) - patch.origin_px;
    const auto update = [](double& error, double off) { error = std::max(error, std::abs(off)); };
    update(worst.position_px, value_at(patch, PatchLayout::kX, uv) - p.x);
    update(worst.position_px, value_at(patch, PatchLayout::kY, uv) - p.y);
    for (int c = 0; c < patch.layout.crossings; ++c) {
      const Vec2 s = record.ray.stop[static_cast<std::size_t>(c)];
      update(worst.stop, value_at(patch, PatchLayout::kStop + 2 * c, uv) - s.x);
      update(worst.stop, value_at(patch, PatchLayout::kStop + 2 * c + 1, uv) - s.y);
    }
    for (int c = 0; c < 3; ++c) {
      const double weight = gain[static_cast<std::size_t>(c)] * record.ray.transmission;
      largest = std::max(largest, weight);
      const double said = patch.gain[static_cast<std::size_t>(c)] * value_at(patch, patch.layout.weight_of(c), uv);
      update(worst.weight, said - weight);
    }
    // A patch does not say which rim each field represents: each must be near that of some surface.
    const auto rims = rims_squared(scene, record);
    for (int r = 0; r < patch.layout.rims; ++r) {
      const double field = value_at(patch, patch.layout.rim(r), uv);
      double nearest = 1e9;
      for (const double rim : rims) nearest = std::min(nearest, std::abs(rim - field));
      update(worst.rim, nearest);
    }
  }
  worst.weight /= largest;
  return worst;
}

struct Case {
  const char* lens;
  LensSettings settings;
  Vec2 angles_deg;
};

const Case kCases[] = {
    {"heliar", {.f_number = 8.0}, {12.0, 7.0}},
    {"heliar", {.f_number = 4.5}, {0.0, -14.0}},
    {"planar-50", {.f_number = 4.0}, {9.0, 3.0}},
    {"canon-70-200", {.focal_length_mm = 200.0, .f_number = 5.6}, {2.0, 1.0}},
};

// The lens's first ghosts whose rays all arrive and whose maps are not nearly linear.
std::vector<test::GhostScene> scenes_of(const Case& c, std::size_t count) {
  constexpr double kRadians = 0.017453292519943295;
  const LensState lens = test::bundled(c.lens, c.settings);
  const Vec3 direction = direction_from_angles(c.angles_deg.x * kRadians, c.angles_deg.y * kRadians);
  std::vector<test::GhostScene> scenes;
  for (const Ghost ghost : enumerate_ghosts(lens, GhostScope::All)) {
    test::GhostScene scene(lens, ghost, direction);
    if (scene.boxes.empty() || scene.ray_set(scene.boxes.front(), 17).failed > 0) continue;
    scenes.push_back(std::move(scene));
    if (scenes.size() == count) break;
  }
  REQUIRE(scenes.size() == count);
  return scenes;
}

}  // namespace

TEST_CASE("a patch agrees with exact rays between its nodes as well as it says") {
  const Rgb gain{1.0, 2.0, 0.5};
  for (const Case& c : kCases) {
    for (const test::GhostScene& scene : scenes_of(c, 4)) {
      CAPTURE(scene.lens.name);
      CAPTURE(scene.ghost.i);
      CAPTURE(scene.ghost.j);
      const Frame frame = frame_on_sensor(scene.lens, 960, 540);
      for (const int nodes : {5, 9, 17}) {
        CAPTURE(nodes);
        const LobattoRays ray_set = scene.ray_set(scene.boxes.front(), nodes, gain);
        const Patch patch = make_patch(ray_set, scene.light, frame);
        CHECK(patch.layout.crossings == scene.path.stop_crossings);
        const PatchError said = estimated_error(patch);
        const PatchError measured = measured_error(scene, ray_set, patch, frame, gain);
        // The constants are the error of packets of doubles with results in float.
        CHECK(measured.position_px <= 2.0 * said.position_px + 1e-4);
        CHECK(measured.stop <= 2.0 * said.stop + 1e-5);
        CHECK(measured.rim <= 2.0 * said.rim + 1e-5);
        CHECK(measured.weight <= 2.0 * said.weight + 2e-4);
        // An overestimate would pass as well: the estimate must not be far too large.
        if (nodes == 9) CHECK(said.position_px <= 100.0 * measured.position_px + 1e-2);
      }
    }
  }
}

TEST_CASE("a ray set half of which is mirrored is the ray set of all rays") {
  const test::GhostScene scene = scenes_of(kCases[0], 1).front();
  const Rectangle& box = scene.boxes.front();
  REQUIRE(box.low.y == -box.high.y);
  const LobattoRays half = scene.ray_set(box, 9);
  Rectangle off = box;
  off.low.y = std::nextafter(off.low.y, 0.0);  // no longer its own mirror image, so traced in full
  const LobattoRays full = scene.ray_set(off, 9);
  for (std::size_t k = 0; k < half.count(); ++k) {
    CHECK(half.sensor_x_mm[k] == test::approx(full.sensor_x_mm[k]).epsilon(1e-5));
    CHECK(half.sensor_y_mm[k] == test::approx(full.sensor_y_mm[k]).epsilon(1e-5).scale(1.0));
    CHECK(half.weight[0][k] == test::approx(full.weight[0][k]).epsilon(1e-4));
    CHECK(half.relative_height[k] == test::approx(full.relative_height[k]).epsilon(1e-5));
    for (std::size_t axis = 0; axis < 2; ++axis) {
      CHECK(half.stop[0][axis][k] == test::approx(full.stop[0][axis][k]).epsilon(1e-5).scale(1.0));
    }
  }
}

TEST_CASE("a ray set turned over is the ray set of the box on the other side of the axis") {
  const test::GhostScene scene = scenes_of(kCases[0], 1).front();
  Rectangle above = scene.boxes.front();
  above.low.y = 0.2 * above.high.y;
  const LobattoRays rotated = mirrored(scene.ray_set(above, 9));
  const LobattoRays traced = scene.ray_set(mirrored(above), 9);
  CHECK(rotated.box == traced.box);
  const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    for (std::size_t k = 0; k < a.size(); ++k) CHECK(a[k] == test::approx(b[k]).epsilon(1e-4).scale(1e-2));
  };
  same(rotated.sensor_x_mm, traced.sensor_x_mm);
  same(rotated.sensor_y_mm, traced.sensor_y_mm);
  same(rotated.relative_height, traced.relative_height);
  same(rotated.rim_squared, traced.rim_squared);
  for (std::size_t axis = 0; axis < 2; ++axis) same(rotated.stop[0][axis], traced.stop[0][axis]);
  for (std::size_t k = 0; k < rotated.count(); ++k) {
    CHECK(rotated.weight[0][k] == test::approx(traced.weight[0][k]).epsilon(1e-4));
    CHECK(rotated.transmission[k] == test::approx(traced.transmission[k]).epsilon(1e-4));
  }
}

TEST_CASE("quarters of a patch are the patch") {
  for (const int nodes : {2, 5, 9, 17}) {
    CAPTURE(nodes);
    const test::GhostScene scene = scenes_of(kCases[1], 1).front();
    const Frame frame = frame_on_sensor(scene.lens, 960, 540);
    const Patch whole = make_patch(scene.ray_set(scene.boxes.front(), nodes), scene.light, frame);
    std::vector<double> scale;
    for (int f = 0; f < whole.layout.fields(); ++f) {
      double largest = 1e-3;
      for (std::size_t k = 0; k < whole.size(); ++k)
        largest = std::max(largest, std::abs(static_cast<double>(whole.field(f)[k])));
      scale.push_back(largest);
    }
    for (const auto& [ix, iy] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{0, 1}, std::pair{1, 1}}) {
      const Patch part = quarter(whole, ix, iy);
      CHECK(part.flux_area_mm2 == test::approx(0.25 * whole.flux_area_mm2));
      CHECK(part.origin_px.x == whole.origin_px.x);
      for (const Vec2 uv : {Vec2{-1, -1}, Vec2{0.3, -0.7}, Vec2{0.9, 0.4}, Vec2{1, 1}}) {
        const Vec2 in_whole{0.5 * (uv.x + (ix == 0 ? -1.0 : 1.0)), 0.5 * (uv.y + (iy == 0 ? -1.0 : 1.0))};
        for (int f = 0; f < whole.layout.fields(); ++f) {
          const double s = scale[static_cast<std::size_t>(f)];
          CHECK(std::abs(value_at(part, f, uv) - value_at(whole, f, in_whole)) < 2e-6 * nodes * s);
        }
      }
    }
  }
}

TEST_CASE("cells between rays that arrived, each a patch of straight lines") {
  const test::GhostScene scene = scenes_of(kCases[0], 1).front();
  const Frame frame = frame_on_sensor(scene.lens, 960, 540);
  const Rectangle box = scene.boxes.front();
  // Corners of the box lie outside the round pupil: cells there are left out.
  CHECK(patches_of_cells(scene.ray_set(box, 17), scene.light, frame).size() < 256);
  const Vec2 quarter = (box.high - box.low) * 0.25;
  LobattoRays ray_set = scene.ray_set({box.low + quarter, box.high - quarter}, 9);
  const double whole = make_patch(ray_set, scene.light, frame).flux_area_mm2;
  const auto area_of = [&] {
    double sum = 0.0;
    for (const Patch& p : patches_of_cells(ray_set, scene.light, frame)) {
      CHECK(p.nodes == 2);
      sum += p.flux_area_mm2;
    }
    return sum;
  };
  CHECK(patches_of_cells(ray_set, scene.light, frame).size() == 64);
  CHECK(area_of() == test::approx(whole));
  // The corners of the last cell are the ray set's own rays.
  const Patch last = patches_of_cells(ray_set, scene.light, frame).back();
  const Vec2 corner = frame.pixel_from_sensor(scene.exact(ray_set.box.high).ray.sensor_mm);
  CHECK(last.field(PatchLayout::kX)[3] + last.origin_px.x == test::approx(corner.x).epsilon(1e-5));
  CHECK(last.field(PatchLayout::kY)[3] + last.origin_px.y == test::approx(corner.y).epsilon(1e-5));

  ray_set.relative_height[10] = INFINITY;  // row 1, column 1: four cells
  CHECK(patches_of_cells(ray_set, scene.light, frame).size() == 60);
  CHECK(area_of() < whole);
}
