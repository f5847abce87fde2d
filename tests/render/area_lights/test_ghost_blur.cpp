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
// pupil with equal light.
GhostMotion motion_with(std::initializer_list<double> densities) {
  GhostMotion motion;
  motion.is_open = true;
  motion.shift_mm = LinearMap{} * 100.0;
  motion.spread_mm = LinearMap{} * 2.0;  // a radius of 20 pixels
  motion.flux_mm2 = 0.01;
  for (const double density : densities)
    motion.lines.push_back({{1.0, 0.0}, {100.0, 0.0}, {}, density, false, 1.0 / static_cast<double>(densities.size())});
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
  // Two thirds of the light are in focus: they fill the blur alone.
  const double expected = 2.0 / 3.0 * flux_px / (std::numbers::pi * blur_px * blur_px + 1.0);
  CHECK(level_of(motion_with({bright, bright, faint})) == test::approx(expected).epsilon(0.02));
}

TEST_CASE("a line of a spot is no brighter than all of the spot's light blurred") {
  const Frame frame{160, 90, 0, 0, 160, 90, kPitch_mm};
  GhostMotion spot = motion_with({1e6, 1e6});
  spot.spread_mm = LinearMap{} * 0.1;  // a radius of one pixel, blurred to four
  spot.lines.push_back({{0.0, 1.0}, {0.0, 100.0}, {}, 1e6, true, 0.1});
  const LightPiece piece = pieces_of(disc()).front();
  const GhostBlur ghost = blur_of(spot, piece, frame, {}, 1.0);
  const double flux_px = 0.01 / (kPitch_mm * kPitch_mm), blur_px = 100.0 * std::tan(kRadius_rad) / kPitch_mm;
  REQUIRE(ghost.lines.size() == 3);
  for (const BlurredLine& line : ghost.lines)
    CHECK(line.height == test::approx(flux_px / (std::numbers::pi * blur_px * blur_px)).epsilon(0.01));
}
