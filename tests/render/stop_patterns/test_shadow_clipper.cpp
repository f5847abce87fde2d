// SPDX-License-Identifier: Apache-2.0
// Dirt's shapes on a polygon, as polygons: against counting, also where shapes overlap.
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "render/stop_patterns/shadow_clipper.h"
#include "support/approx.h"
#include "support/sanitized.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::stop_patterns;

namespace {

LensState plate_with(double dust_per_cm2, double opacity) {
  LensState lens = test::plate();
  lens.dirt.plane = DirtPlane::Stop;
  lens.dirt.dust_per_cm2 = dust_per_cm2;
  lens.dirt.dust_mm = 0.6;
  lens.dirt.scratches_per_cm2 = 10.0;
  lens.dirt.scratch_width_mm = 0.2;
  lens.dirt.scratch_bend_rad = 1.5;
  lens.dirt.opacity = opacity;
  lens.dirt.seed = 3;
  return lens;
}

double twice_area(std::span<const Vec2> p) {
  double sum = 0.0;
  for (std::size_t k = 2; k < p.size(); ++k) sum += cross(p[k - 1] - p[0], p[k] - p[0]);
  return sum;
}

bool holds(std::span<const Vec2> polygon, Vec2 p) {
  for (std::size_t k = 0; k < polygon.size(); ++k)
    if (cross(polygon[(k + 1) % polygon.size()] - polygon[k], p - polygon[k]) < 0.0) return false;
  return true;
}

}  // namespace

TEST_CASE("shadows take from a polygon what counting says, at every point, overlaps and all") {
  // A triangle of pixels with a rotated, mirrored and sheared view of the stop.
  const std::vector<Vec2> triangle{{2.0, 1.0}, {30.0, 6.0}, {11.0, 24.0}};
  const PlaneView view{{-2.0, 2.4}, {0.14, -0.02}, {-0.03, -0.17}};
  for (const double dust : {20.0, 150.0}) {
    if (test::kSanitized && dust > 20.0) continue;
    for (const double opacity : {1.0, 0.5}) {
      for (const std::size_t crossings : {std::size_t{1}, std::size_t{2}}) {
        CAPTURE(dust);
        CAPTURE(opacity);
        CAPTURE(crossings);
        const DirtField field(plate_with(dust, opacity));
        const std::vector<PlaneView> views{view, {{2.0, -1.0}, {-0.1, 0.05}, {0.03, 0.12}}};
        struct Shadow {
          std::vector<Vec2> outline;
          double blocked;
        };
        std::vector<Shadow> shadows;
        ShadowClipper().for_each(field, {views.data(), crossings}, triangle, 0.002, [&](auto outline, double blocked) {
          CHECK(twice_area(outline) > 0.0);
          shadows.push_back({{outline.begin(), outline.end()}, blocked});
        });
        REQUIRE(shadows.size() > 10);
        double drawn = 0.0;
        for (const Shadow& s : shadows) drawn += 0.5 * twice_area(s.outline) * s.blocked;
        double counted = 0.0;
        int inside = 0, wrong = 0;
        constexpr double kStep = 0.13;
        for (double y = 1.0; y < 24.0; y += kStep) {
          for (double x = 2.0; x < 30.0; x += kStep) {
            if (!holds(triangle, {x, y})) continue;
            ++inside;
            double open = 1.0;
            for (std::size_t c = 0; c < crossings; ++c)
              for (const DirtStroke& s : field.shapes())
                if (s.distance_mm(views[c].at({x, y})) < 0.0) open *= 1.0 - opacity;
            counted += (1.0 - open) * kStep * kStep;
            double left = 1.0;
            for (const Shadow& s : shadows)
              if (holds(s.outline, {x, y})) left -= s.blocked;
            wrong += std::abs(left - open) > 1e-6 ? 1 : 0;
          }
        }
        CHECK(drawn == test::approx(counted).epsilon(5e-3));
        CHECK(wrong < inside / 200);  // only near outlines, which are polygons here
      }
    }
  }
}

TEST_CASE("mean over an ellipse, clean points and what is near a box are those of the shapes") {
  const DirtField field(plate_with(40.0, 1.0));
  double open = 0.0;
  int count = 0;
  for (double y = -2.9; y < 2.9; y += 0.02) {
    for (double x = -2.9; x < 2.9; x += 0.02) {
      if (x * x + y * y > 2.8 * 2.8) continue;
      bool dark = false;
      for (const DirtStroke& s : field.shapes()) dark = dark || s.distance_mm({x, y}) < 0.0;
      open += dark ? 0.0 : 1.0;
      ++count;
    }
  }
  CHECK(field.mean_within({-2.8, -2.8}, {2.8, 2.8}) == test::approx(open / count).epsilon(0.01));
  for (double x = -2.5; x < 2.5; x += 0.31) {
    for (double radius : {0.01, 0.1, 0.5}) {
      double nearest = 1e9;
      for (const DirtStroke& s : field.shapes()) nearest = std::min(nearest, s.distance_mm({x, 0.4 * x}));
      if (nearest <= radius) CHECK_FALSE(field.is_clean({x, 0.4 * x}, radius));
      if (radius < 0.06) CHECK(field.is_clean({x, 0.4 * x}, radius) == (nearest > radius));
    }
  }
  std::vector<std::uint32_t> found;
  field.find_within({-0.3, 0.2}, {0.5, 0.9}, found);
  for (std::uint32_t k = 0; k < field.shapes().size(); ++k) {
    const bool meets = field.shapes()[k].distance_mm({0.1, 0.55}) < 0.35;
    if (meets) CHECK(std::find(found.begin(), found.end(), k) != found.end());
  }
  // Invalid points.
  const double nan = std::nan("");
  CHECK(field.transmission({{nan, 0.0}, 0.1}) == 1.0);
  CHECK(field.transmission({{1e30, -1e30}, 0.1}) >= 0.0);
  field.find_within({nan, nan}, {nan, nan}, found);
}
