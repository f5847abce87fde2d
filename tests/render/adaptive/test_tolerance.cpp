// SPDX-License-Identifier: Apache-2.0
// The tolerances of fits: they depend on where a ghost's light is, not on where blocked rays would go.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <doctest/doctest.h>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/tolerance.h"
#include "render/ray_maps/lobatto.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

constexpr int kNodes = 5;

// The rays of a pupil of 2 x 2 mm about the axis, all of which get through.
LobattoRays rays_of(const std::function<Vec2(Vec2)>& sensor_mm) {
  LobattoRays ray_set;
  ray_set.nodes = kNodes;
  ray_set.box = {{-1.0, -1.0}, {1.0, 1.0}};
  const auto points = lobatto_points(kNodes);
  for (const double y : points) {
    for (const double x : points) {
      const Vec2 at = sensor_mm({x, y});
      ray_set.sensor_x_mm.push_back(static_cast<float>(at.x));
      ray_set.sensor_y_mm.push_back(static_cast<float>(at.y));
      ray_set.relative_height.push_back(0.5F);
    }
  }
  return ray_set;
}

Frame frame_of_small_pixels() {
  Frame frame;
  frame.pixel_pitch_mm = 0.01;
  return frame;
}

constexpr double kLight = 1e-6;  // flux per mm^2 of the pupil

Tolerance within(const LobattoRays& ray_set, const ErrorBudget& budget) {
  return tolerance_for(ray_set, kLight, 1.0, frame_of_small_pixels(), budget);
}
Tolerance of(const LobattoRays& ray_set) { return within(ray_set, {1e-8, 1.0}); }

}  // namespace

TEST_CASE("an even ghost may be displaced by its squared error over twice the light along its edges") {
  // 2 x 2 mm of the pupil over 400 x 400 pixels.
  const Tolerance t = of(rays_of([](Vec2 p) { return p * 2.0; }));
  const double level = 4e-6 / (400.0 * 400.0);
  CHECK(t.level / level == test::approx(1.0).epsilon(1e-6));
  const double error = 0.3 * 1e-4 / level;
  CHECK(t.weight == test::approx(std::min(0.5, error / 400.0)));
  CHECK(t.position_px == test::approx(0.05 * 400.0 + 0.5));  // not larger, whatever is allowed
  const Tolerance strict = within(rays_of([](Vec2 p) { return p * 2.0; }), {1e-19, 1.0});
  const double little = 0.3 * std::sqrt(1e-19) / level;
  CHECK(strict.position_px == test::approx(little / (2.0 * 20.0)));
  CHECK(strict.weight == test::approx(little / 400.0));
}

TEST_CASE("rays that are flung far away beyond a rim loosen nothing") {
  const auto even = [](Vec2 p) { return p * 2.0; };
  LobattoRays flung = rays_of(even);
  for (std::size_t k = 0; k < flung.count(); ++k) {
    if (k % kNodes < 3) continue;
    flung.relative_height[k] = 1.5F;
    if (k % kNodes == 4) flung.sensor_x_mm[k] *= 1000.0F;
  }
  CHECK(of(flung).level / of(rays_of(even)).level == test::approx(1.0).epsilon(1e-6));
}

TEST_CASE("a ghost most of whose light gathers is held to the level there") {
  const double level = of(rays_of([](Vec2 p) { return p * 2.0; })).level;
  // The left half of the pupil on a tenth of its width.
  const Tolerance gathered = of(rays_of([](Vec2 p) { return Vec2{p.x < 0.0 ? 0.2 * p.x : 2.0 * p.x, 2.0 * p.y}; }));
  CHECK(gathered.level / level == test::approx(0.5 * (1.0 + 10.0)).epsilon(1e-5));
}

TEST_CASE("a ghost that is smaller than a pixel has its whole light in one") {
  for (const double side_px : {0.1, 0.5, 1.0})
    CHECK(of(rays_of([&](Vec2 p) { return p * (0.005 * side_px); })).level / 4e-6 == test::approx(0.93).epsilon(0.08));
  // One of two pixels' length along each side lies in four.
  CHECK(of(rays_of([](Vec2 p) { return p * 0.01; })).level / 4e-6 == test::approx(0.23).epsilon(0.08));
}

TEST_CASE("where no ray tells where a ghost lies, a small frame does") {
  LobattoRays failed = rays_of([](Vec2 p) { return p * 2.0; });
  std::fill(failed.relative_height.begin(), failed.relative_height.end(), std::numeric_limits<float>::infinity());
  CHECK(of(failed).level / 4e-6 == test::approx(1.0));  // all of it in one pixel
  const auto about = [&](double level, double area_px) {
    return tolerance_for(failed, 1.0, 1.0, frame_of_small_pixels(), {1e-8, 1.0, {level, area_px}});
  };
  CHECK(about(1e-7, 400.0 * 400.0).level == 1e-7);
  CHECK(about(1e-7, 400.0 * 400.0).position_px > 100.0 * about(0.0, 0.0).position_px);
}

TEST_CASE("colours visible next to the peak stay within a fiftieth of a ghost's size, or a pixel") {
  const auto colour_px = [](double size, double peak) {
    return tolerance_for(rays_of([&](Vec2 p) { return p * size; }), 1e-6, 1.0, frame_of_small_pixels(), {1e-8, peak})
        .colour_px;
  };
  const double level = 4e-6 / (400.0 * 400.0);  // of a ghost of 400 x 400 pixels
  CHECK(colour_px(2.0, level * 3000.0) == test::approx(8.0));
  CHECK(colour_px(2.0, level * 3700.0) > 1e6);
  CHECK(colour_px(0.02, level) == test::approx(1.0));
}

TEST_CASE("without a limit light may be off by a fiftieth of a ghost's size; without light anything will do") {
  const LobattoRays ray_set = rays_of([](Vec2 p) { return p; });
  const Tolerance preview_shift = within(ray_set, {HUGE_VAL, 1.0});
  CHECK(preview_shift.position_px == test::approx(0.02 * 200.0 + 0.5));
  CHECK(std::min(preview_shift.stop, preview_shift.weight) > 1e6);
  CHECK(tolerance_for(ray_set, 0.0, 1.0, frame_of_small_pixels(), {1e-8, 1.0}).position_px > 1e6);
}

TEST_CASE("light that is known to focus between rays has the tolerance that rays there would give") {
  const LobattoRays ray_set = rays_of([](Vec2 p) { return p * 2.0; });
  const double level = 4.0 * kLight / (400.0 * 400.0);
  const auto t = [&](const LevelEstimate& about) { return within(ray_set, {1e-19, 1.0, about}); };
  CHECK(t({0.5 * level, 100.0}).position_px == t({}).position_px);  // dimmer than the rays show: the rays count
  const Tolerance gathered = t({8.0 * level, 900.0});
  const double error = 0.3 * std::sqrt(1e-19) / (8.0 * level);
  CHECK(gathered.level == 8.0 * level);
  CHECK(gathered.position_px == test::approx(error / (2.0 * std::sqrt(30.0))));
  CHECK(gathered.weight == test::approx(error / 30.0));
}
