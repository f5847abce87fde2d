// SPDX-License-Identifier: Apache-2.0
// A ghost of a light with a size in a frame: its level, by which errors count.
#include <cmath>
#include <initializer_list>
#include <numbers>

#include <doctest/doctest.h>

#include "render/area_lights/ghost_blur.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

constexpr double kPitch_mm = 0.1;
constexpr double kRadius_rad = 0.004;

Light disc() {
  Light light;
  light.direction = {0.0, 0.0, 1.0};
  light.radius_rad = kRadius_rad;
  return light;
}

// A ghost in the middle of the frame that moves by 100 mm for each unit of the tangent. densities: of parts of the
// pupil with equal light, each of which would fill a disc if it had all light of the ghost.
GhostMotion motion_with(std::initializer_list<double> densities) {
  GhostMotion motion;
  motion.is_open = true;
  motion.shift_mm = LinearMap{} * 100.0;
  motion.spread_mm = LinearMap{} * 2.0;  // a radius of 20 pixels
  motion.flux_mm2 = 0.01;
  for (const double density : densities)
    motion.lines.push_back({{1.0, 0.0},
                            {100.0, 0.0},
                            {},
                            density,
                            false,
                            1.0 / static_cast<double>(densities.size()),
                            LinearMap{} * (motion.flux_mm2 / density / (4.0 * std::numbers::pi))});
  return motion;
}

double level_of(const GhostMotion& motion) {
  const Frame frame{160, 90, 0, 0, 160, 90, kPitch_mm};
  return blur_of(motion, pieces_of(disc()).front(), frame, {}, 1.0).level;
}

}  // namespace

TEST_CASE("the level of a ghost of even brightness is its flux over the area of ghost and blur") {
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  const double even = flux_px / (std::numbers::pi * 20.0 * 20.0);  // its density: a pixel's value over the light's
  const double expected = flux_px / (std::numbers::pi * (20.0 * 20.0 + blur_px * blur_px) + 1.0);
  CHECK(level_of(motion_with({even, even, even})) == test::approx(expected).epsilon(0.02));
}

TEST_CASE("the level of a ghost with most of its light in one place is not that of its whole extent") {
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  const double faint = 0.01 * flux_px / (std::numbers::pi * 20.0 * 20.0), bright = 1e6;
  // Two thirds of the light are in focus: they fill the blur alone, and count by their light.
  const double expected = 4.0 / 9.0 * flux_px / (std::numbers::pi * blur_px * blur_px + 1.0);
  CHECK(level_of(motion_with({bright, bright, faint})) == test::approx(expected).epsilon(0.02));
}

TEST_CASE("the level of a thin ghost blurred across is that of the area swept, however thin ghost and blur are") {
  GhostMotion thin = motion_with({1e6, 1e6, 1e6, 1e6});
  for (GhostLine& line : thin.lines) line.covariance_mm2 = {{0.0, 0.0}, {0.0, 1.0}};  // 40 pixels high
  thin.shift_mm = {{100.0, 0.0}, {0.0, 0.0}};  // moves to the side only
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  CHECK(level_of(thin) == test::approx(flux_px / (std::numbers::pi * 20.0 * blur_px)).epsilon(0.05));
}

TEST_CASE("light beside the frame does not count for the level of what lies in it") {
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  GhostMotion motion = motion_with({1e6, 1e6});
  motion.lines.back().at_mm = {1000.0, 0.0};
  const double expected = 0.5 * flux_px / (std::numbers::pi * blur_px * blur_px + 1.0);
  CHECK(level_of(motion) == test::approx(expected).epsilon(0.02));
}

TEST_CASE("a spot that is drawn with another blur changes in all directions, whatever the directions of its lines") {
  const Frame frame{160, 90, 0, 0, 160, 90, kPitch_mm};
  GhostMotion spot = motion_with({1e6});
  spot.spread_mm = LinearMap{} * 0.1;
  spot.lines.push_back({{1.0, 0.0}, {100.0, 0.0}, {}, 1e6, true, 0.1, kZeroMap});
  const LightPiece piece = pieces_of(disc()).front();
  const GhostBlur ghost = blur_of(spot, piece, frame, {}, 1.0);
  LinearMap taller = ghost.px;
  taller.y = taller.y * 2.0;
  const double peak = ghost.level;
  CHECK(map_error(ghost, taller, piece, peak) < 1e-6);
  // The disc of the light becomes an ellipse: the area between them is what it covers in addition.
  const double radius_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  const double seen = map_error(as_drawn(ghost, piece), taller, piece, peak);
  CHECK(seen > 0.1 * std::numbers::pi * radius_px * radius_px);
  CHECK(seen < std::numbers::pi * radius_px * radius_px);
}

TEST_CASE("a line of a spot is no brighter than all of the spot's light blurred") {
  const Frame frame{160, 90, 0, 0, 160, 90, kPitch_mm};
  GhostMotion spot = motion_with({1e6, 1e6});
  spot.spread_mm = LinearMap{} * 0.1;  // a radius of one pixel, blurred to four
  spot.lines.push_back({{0.0, 1.0}, {0.0, 100.0}, {}, 1e6, true, 0.1, kZeroMap});
  const LightPiece piece = pieces_of(disc()).front();
  const GhostBlur ghost = blur_of(spot, piece, frame, {}, 1.0);
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  REQUIRE(ghost.lines.size() == 3);
  for (const BlurredLine& line : ghost.lines)
    CHECK(line.height == test::approx(flux_px / (std::numbers::pi * blur_px * blur_px)).epsilon(0.05));
}
