// SPDX-License-Identifier: Apache-2.0
// The part of a cell that the iris leaves open.
#include <doctest/doctest.h>

#include <numbers>
#include <random>

#include "render/adaptive/clip/polygon_clipper.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

constexpr double kSide_px = 10.0;

// A cell of kSide_px x kSide_px pixels with these stop coordinates at its corners: four, or eight with the middles of
// its sides.
template <std::size_t N>
std::array<Corner, N> cell_with(const std::array<Vec2, N>& stop) {
  constexpr std::array<Vec2, 8> kUv{Vec2{0, 0}, Vec2{0.5, 0}, Vec2{1, 0}, Vec2{1, 0.5},
                                    Vec2{1, 1}, Vec2{0.5, 1}, Vec2{0, 1}, Vec2{0, 0.5}};
  std::array<Corner, N> cell;
  for (std::size_t k = 0; k < N; ++k) {
    const Vec2 uv = kUv[k * (8 / N)];
    cell[k].position = uv * kSide_px;
    cell[k].uv = uv;
    cell[k].limit[0] = static_cast<float>(stop[k].x);
    cell[k].limit[1] = static_cast<float>(stop[k].y);
  }
  return cell;
}

double area_of(std::span<const Corner> polygon) {
  double twice = 0.0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Vec2 from = polygon[0].position;
    twice += cross(polygon[k - 1].position - from, polygon[k].position - from);
  }
  return 0.5 * std::abs(twice);
}

}  // namespace

TEST_CASE("a round iris inside a cell leaves its area") {
  const IrisShape iris{Iris{}};
  PolygonClipper clipper(iris);
  const double r = 0.25;  // of the iris, in cells
  for (const double step : {0.8, 0.2, 0.05}) {
    const auto cell = cell_with<4>({Vec2{-2, -2}, Vec2{2, -2}, Vec2{2, 2}, Vec2{-2, 2}});
    const double whole = std::numbers::pi * r * r * kSide_px * kSide_px;
    CHECK(area_of(clipper.open_part(cell, cell, 1, 0, step)) == test::approx(whole).epsilon(1e-6));
  }
}

// Small ghosts, whose error allows long chords, had lost up to 7 per cent of their light.
TEST_CASE("a short arc through a cell leaves the area below it, however long its chords may be") {
  const IrisShape iris{Iris{}};
  PolygonClipper clipper(iris);
  for (const double half : {0.1, 0.2, 0.35}) {
    const auto cell = cell_with<4>({Vec2{-half, 0.7}, Vec2{half, 0.7}, Vec2{half, 1.4}, Vec2{-half, 1.4}});
    const double in_stop = half * std::sqrt(1.0 - half * half) + std::asin(half) - 1.4 * half;
    const double whole = in_stop / (1.4 * half) * kSide_px * kSide_px;
    CHECK(area_of(clipper.open_part(cell, cell, 1, 0, 0.8)) == test::approx(whole).epsilon(1e-3));
  }
}

TEST_CASE("what two crossings of a round iris both leave, be it ever so narrow") {
  const IrisShape iris{Iris{}};
  PolygonClipper clipper(iris);
  for (const double apart : {0.5, 1.4, 1.8, 1.95}) {
    auto cell = cell_with<4>({Vec2{-2, -2}, Vec2{2, -2}, Vec2{2, 2}, Vec2{-2, 2}});
    for (Corner& c : cell) c.limit[2] = c.limit[0] + static_cast<float>(apart), c.limit[3] = c.limit[1];
    const double in_stop = 2.0 * std::acos(0.5 * apart) - 0.5 * apart * std::sqrt(4.0 - apart * apart);
    const double whole = in_stop / 16.0 * kSide_px * kSide_px;
    CHECK(area_of(clipper.open_part(cell, cell, 2, 0, 0.8)) == test::approx(whole).epsilon(0.01));
  }
}

TEST_CASE("a rim that bends within a cell of curved sides cuts along its curve") {
  const IrisShape iris{Iris{}};
  PolygonClipper clipper(iris);
  // Squared heights over the rim's radius, r cells about the cell's first corner.
  for (const double r : {0.5, 0.8, 0.95}) {
    CAPTURE(r);
    const auto height = [&](Vec2 uv) { return Vec2{dot(uv, uv) / (r * r), 0.0}; };
    const auto curved = cell_with<8>({height({0, 0}), height({0.5, 0}), height({1, 0}), height({1, 0.5}),
                                      height({1, 1}), height({0.5, 1}), height({0, 1}), height({0, 0.5})});
    const auto straight = cell_with<4>({height({0, 0}), height({1, 0}), height({1, 1}), height({0, 1})});
    const double whole = std::numbers::pi / 4.0 * r * r * kSide_px * kSide_px;
    CHECK(area_of(clipper.open_part(curved, curved, 0, 1, 0.1)) / whole == test::approx(1.0).epsilon(0.06));
    CHECK(std::abs(area_of(clipper.open_part(straight, straight, 0, 1, 0.1)) / whole - 1.0) > 0.1);
  }
}

TEST_CASE("arcs and straight edges lie where curved stop coordinates put them") {
  // The stop coordinates are (u, v) curved by a parabola: x = u + b 4 v (1 - v). Areas in uv are those of the opening.
  constexpr double b = 0.04;  // more is not accepted
  const auto stop = [&](Vec2 uv) { return Vec2{uv.x + b * 4.0 * uv.y * (1.0 - uv.y) - 0.5, uv.y - 0.5} * 4.0; };
  const auto cell = cell_with<8>({stop({0, 0}), stop({0.5, 0}), stop({1, 0}), stop({1, 0.5}), stop({1, 1}),
                                  stop({0.5, 1}), stop({0, 1}), stop({0, 0.5})});
  const IrisShape round{Iris{}};
  PolygonClipper by_circle(round);
  const double disc = std::numbers::pi / 16.0 * kSide_px * kSide_px;  // the map preserves areas up to the scale
  CHECK(area_of(by_circle.open_part(cell, cell, 1, 0, 0.05)) == test::approx(disc).epsilon(1e-3));
  const IrisShape square{Iris{.blades = 4}};
  PolygonClipper by_lines(square);
  CHECK(area_of(by_lines.open_part(cell, cell, 1, 0, 0.05)) ==
        test::approx(disc * 2.0 / std::numbers::pi).epsilon(0.012));
}

// A ghost of the Nikon had become a polygon of 1e10 pixels where the map to the stop folds within a cell.
TEST_CASE("nothing is cut to beyond the cell, wherever its corners cross the stop") {
  const IrisShape iris{Iris{}};
  PolygonClipper clipper(iris);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> anywhere(-2.0, 2.0);
  constexpr double kRounding = 1e-9;
  int cut = 0;
  for (int round = 0; round < 5000; ++round) {
    std::array<Vec2, 8> stop;
    for (Vec2& s : stop) s = {anywhere(random), anywhere(random)};
    const auto curved = cell_with(stop);
    const auto cell = cell_with<4>({stop[0], stop[1], stop[2], stop[3]});
    const std::span<const Corner> whole =
        round % 3 == 0 ? std::span<const Corner>(curved) : std::span<const Corner>(cell.data(), round % 3 == 1 ? 4 : 3);
    const auto part = clipper.open_part(whole, whole, 1, 0, 0.1);
    if (part.size() > 4) ++cut;
    bool inside = true;
    for (const Corner& c : part) {
      for (const double v : {c.position.x, c.position.y})
        inside = inside && v >= -kRounding && v <= kSide_px + kRounding;
      if (whole.size() == 3) inside = inside && c.uv.y <= c.uv.x + kRounding;
    }
    CAPTURE(round);
    CHECK(inside);
  }
  CHECK(cut > 1000);
}
