// SPDX-License-Identifier: Apache-2.0
// The parts of the search for boxes of the pupil, each against the rays of a dense grid.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>

#include <doctest/doctest.h>

#include "render/pupils/clearance_grid.h"
#include "render/pupils/ghost_pupil.h"
#include "render/pupils/kept_pupils.h"
#include "render/pupils/meridian_scan.h"
#include "render/pupils/pupil_search.h"
#include "render/pupils/stop_newton_step.h"
#include "render/ray_maps/ghost_scene.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::pupils;

namespace {

struct Setting {
  LensState lens;
  LightFrame light;
  EntranceWindow window;
  OpticalPath path;
  ReflectanceTables tables;

  Setting(const char* name, double f_number, Ghost ghost, double angle_rad)
      : lens(test::lens_at_f(name, f_number)), light(Vec3{std::sin(angle_rad), 0.0, std::cos(angle_rad)}),
        window(entrance_window(lens, light.source)), path(ghost_path(lens, ghost, 550.0)), tables(lens, 550.0) {}

  [[nodiscard]] PacketPath packets() const { return {path, tables, {{0.0, 0.0, window.z_mm}, light.source}}; }
  [[nodiscard]] Rectangle half() const { return {{window.min_mm.x, 0.0}, window.max_mm}; }
};

// The bounds of those rays of a grid over a box that get through, by trace().
std::optional<Rectangle> open_bounds(const Setting& s, const Rectangle& box, int side) {
  std::optional<Rectangle> bounds;
  for (int k = 0; k < side * side; ++k) {
    const Vec2 p{std::lerp(box.low.x, box.high.x, (k % side) / (side - 1.0)),
                 std::lerp(box.low.y, box.high.y, std::floor(k / side) / (side - 1.0))};
    const TracedRay ray = trace(s.path, {{p.x, p.y, s.window.z_mm}, s.light.source.direction});
    if (ray.status != RayStatus::Ok || blocked_by(ray, s.path, Iris{}) > 0.0) continue;
    if (!bounds) bounds = {p, p};
    bounds->low = {std::min(bounds->low.x, p.x), std::min(bounds->low.y, p.y)};
    bounds->high = {std::max(bounds->high.x, p.x), std::max(bounds->high.y, p.y)};
  }
  return bounds;
}

bool holds(const Rectangle& outer, const Rectangle& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.high.x >= inner.high.x &&
         outer.high.y >= inner.high.y;
}

}  // namespace

TEST_CASE("a box aimed at the stop from a coarse grid holds what gets through, but for a tenth of its half") {
  int aimed = 0;
  for (const Ghost ghost : enumerate_ghosts(test::lens_at_f("canon-70-200", 32.0), GhostScope::OneSideOfStop)) {
    if (ghost.i % 4 != 1) continue;
    const Setting s("canon-70-200", 32.0, ghost, 0.05);
    ClearanceGrid grid(s.packets());
    grid.trace(s.half(), 12, 6);
    for (const auto& piece : grid.components(1.0F)) {
      const auto aim = newton_step_to_stop(grid, piece);
      if (!aim || aim->error > 0.1) continue;
      const Vec2 more = (aim->box.high - aim->box.low) * 0.5;
      const auto open = open_bounds(s, {aim->box.low - more, aim->box.high + more}, 60);
      if (!open) continue;  // a rim blocks them
      ++aimed;
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      const Vec2 tenth = (aim->box.high - aim->box.low) * 0.05;
      CHECK(holds({aim->box.low - tenth, aim->box.high + tenth}, *open));
    }
  }
  CHECK(aimed > 30);
}

TEST_CASE("a pupil a three-hundredth of the window wide, among rays that fail, is found along the meridian") {
  // From a search by 193 x 193 rays: x from -6.0515 to -5.9018.
  const Setting s("nikon-80-200", 11.0, {7, 12}, 0.37 * 0.27);
  const auto open = open_bounds(s, {{-9.0, -0.5}, {-3.0, 0.5}}, 301);
  REQUIRE(open.has_value());
  CHECK(open->high.x - open->low.x < 0.5);
  ClearanceGrid grid(s.packets());
  grid.trace(s.half(), 12, 6);
  bool seen = false;
  for (int k = 0; k <= 12; ++k) seen = seen || grid.is_open(grid.at(k, 0));
  CHECK_FALSE(seen);

  MeridianScan scan(s.packets());
  const auto found = scan.find({s.window.min_mm.x, s.window.max_mm.x}, {});
  CHECK(std::any_of(found.begin(), found.end(),
                    [&](const Interval& i) { return i.low <= open->low.x && i.high >= open->high.x; }));
  CHECK(scan.rays() < 150);

  // Nothing is found twice.
  MeridianScan again(s.packets());
  const Rectangle box{{open->low.x - 1.0, -1.0}, {open->high.x + 1.0, 1.0}};
  for (const Interval& i : again.find({s.window.min_mm.x, s.window.max_mm.x}, {&box, 1})) {
    CHECK((i.high <= open->low.x || i.low >= open->high.x));
  }
}

TEST_CASE("a pupil between the meridian's rays, all of which fail, is found where they fail least") {
  const Setting s("nikon-80-200", 2.8, {7, 19}, 0.2332);
  const auto open = open_bounds(s, {{-30.35, -0.05}, {-30.2, 0.05}}, 101);
  REQUIRE(open.has_value());
  CHECK(open->high.x - open->low.x < 0.2);
  const Pupil found = find_pupil(PupilRays(s.packets(), s.window), {.along_meridian = true});
  CHECK(std::ranges::any_of(found.boxes, [&](const Rectangle& box) { return holds(box, *open); }));
  CHECK(found.rays < 400);
}

TEST_CASE("a pupil that only one end of the spectrum opens is found") {
  // The Canon's ghost 10-20 is open from 540 nm on. It was searched at the middle wavelength alone.
  const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0});
  const Light light = test::light_at(lens, frame_on_sensor(lens, 640, 360), {0.66, 0.38});
  const LightSource source{light.direction};
  const EntranceWindow window = LightWindows(lens, source).of(true);
  const std::array lambda_nm{460.0, 530.0, 610.0};
  const TablesByWavelength tables(lens);
  const StepsByWavelength steps(lens, tables);
  const auto boxes_at = [&](std::span<const double> at_nm) {
    return find_ghost_pupil({steps, {10, 20}, source, window, at_nm}).boxes;
  };
  CHECK(boxes_at(std::span(lambda_nm).first(2)).empty());
  REQUIRE(boxes_at(lambda_nm).size() == 1);
  const Rectangle found = boxes_at(lambda_nm).front(), red = boxes_at(std::span(lambda_nm).last(1)).front();
  CHECK(holds(found, red));
}

TEST_CASE("boxes fitted at another wavelength grow to hold what gets through, and shrink to it") {
  const Setting s("heliar", 11.0, {1, 4}, 0.2);
  const auto open = open_bounds(s, {s.window.min_mm, s.window.max_mm}, 201);
  REQUIRE(open.has_value());
  const Vec2 size = open->high - open->low;
  const auto fit = [&](const Rectangle& hint) {
    return find_pupil(PupilRays(s.packets(), s.window), {.along_meridian = true, .hint = hint});
  };
  const Pupil grown = fit({open->low + size * 0.2, open->high - size * 0.2});
  REQUIRE(grown.boxes.size() == 1);
  CHECK(holds(grown.box(), *open));
  CHECK(area_of(grown.box()) < 2.0 * area_of(*open));
  CHECK(grown.rays > 0);
  const Pupil shrunk = fit({open->low - size, open->high + size});
  REQUIRE(shrunk.boxes.size() == 1);
  CHECK(holds(shrunk.box(), *open));
  CHECK(area_of(shrunk.box()) < 3.5 * area_of(*open));
  CHECK(fit({open->high + size, open->high + size * 1.5}).is_empty());
}

TEST_CASE("a search over a window that the caller cancels finds nothing, and is not kept") {
  const Setting s("heliar", 11.0, {1, 4}, 0.2);
  std::atomic<bool> cancel = false;
  const Context context{.cancel = &cancel};
  KeptPupils kept(KeptPupils::key_of(s.lens));
  int searches = 0;
  const auto find = [&] {
    return kept.find_window_pupil(
        {{1, 4}, s.light.source, 550.0, s.path.stop_radius_mm, Iris{}, PupilEffort::Finest, &context}, [&] {
          ++searches;
          PupilRays rays(s.packets(), s.window);
          RayGrid grid;
          return find_pupil(rays, {.context = &context}, grid);
        });
  };
  cancel = true;
  CHECK(find().is_empty());
  cancel = false;
  const Pupil found = find();
  REQUIRE_FALSE(found.is_empty());
  CHECK(find().box() == found.box());
  CHECK(searches == 2);

  // The same bits as without a caller to ask.
  const Pupil alone = find_pupil(PupilRays(s.packets(), s.window), {});
  CHECK(found.box() == alone.box());
  CHECK(found.sensor_mm == alone.sensor_mm);
}
