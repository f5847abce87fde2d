// SPDX-License-Identifier: Apache-2.0
// Interpolation between a cell's corners, and where its rays cross the stop.
#include <doctest/doctest.h>

#include <random>

#include "render/adaptive/clip/isoparametric_cell.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::adaptive;

namespace {

constexpr std::size_t kLimits = 3;

// The points of a cell's corners, by their number, in order from uv (0, 0).
std::vector<Vec2> corner_points(std::size_t corners) {
  if (corners == 3) return {{0, 0}, {1, 0}, {1, 1}};
  if (corners == 4) return {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return {{0, 0}, {0.5, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0.5, 1}, {0, 1}, {0, 0.5}};
}

// A map from uv to points of a frame, with a bend that eight corners represent and four do not.
Vec2 position_at(Vec2 uv, double sag) {
  return {100.0 + 20.0 * uv.x - 3.0 * uv.y + sag * uv.x * uv.x, 50.0 + 2.0 * uv.x + 10.0 * uv.y - sag * uv.x * uv.y};
}
// A map from uv to points in the stop.
Vec2 stop_at(Vec2 uv, double sag) {
  return {-0.6 + 1.1 * uv.x + 0.2 * uv.y + 0.1 * sag * uv.y * uv.y,
          -0.4 + 0.1 * uv.x + 0.9 * uv.y + 0.1 * sag * uv.x * uv.y};
}

std::vector<Corner> cell_of(std::size_t corners, double sag) {
  std::vector<Corner> cell;
  for (const Vec2 uv : corner_points(corners)) {
    const Vec2 stop = stop_at(uv, sag);
    cell.push_back({position_at(uv, sag), uv, {static_cast<float>(stop.x), static_cast<float>(stop.y), 0.5F}});
  }
  return cell;
}

double sag_of(std::size_t corners) { return corners == 8 ? 1.0 : 0.0; }

}  // namespace

TEST_CASE("a cell says between its corners what they were made from") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  for (const std::size_t corners : {3U, 4U, 8U}) {
    CAPTURE(corners);
    const std::vector<Corner> cell = cell_of(corners, sag_of(corners));
    const IsoparametricCell whole(cell, kLimits);
    CHECK(whole.is_curved() == (corners == 8));
    for (int k = 0; k < 50; ++k) {
      Vec2 uv{any(random), any(random)};
      if (corners == 3 && uv.y > uv.x) std::swap(uv.x, uv.y);
      const Corner at = whole.at(uv);
      CHECK(at.uv == uv);
      CHECK(length(at.position - position_at(uv, sag_of(corners))) < 1e-9);
      CHECK(length(Vec2{at.limit[0], at.limit[1]} - stop_at(uv, sag_of(corners))) < 1e-6);
      CHECK(at.limit[2] == test::approx(0.5).epsilon(1e-6));
    }
  }
}

TEST_CASE("rays cross the stop where they are asked to, however many at once") {
  for (const std::size_t corners : {3U, 4U, 8U}) {
    for (std::size_t count = 0; count <= 20; ++count) {
      CAPTURE(corners);
      CAPTURE(count);
      const std::vector<Corner> cell = cell_of(corners, sag_of(corners));
      std::vector<Vec2> uv, stop;
      for (std::size_t k = 0; k < count; ++k) {
        const double t = static_cast<double>(k) / 20.0;
        uv.push_back({0.3 + 0.6 * t, 0.1 + 0.2 * t * (1.0 - t)});
        stop.push_back(stop_at(uv.back(), sag_of(corners)));
      }
      std::vector<Corner> found(1);  // crossings are appended
      IsoparametricCell(cell, kLimits).add_crossing(stop, 0, {0.3, 0.1}, found);
      REQUIRE(found.size() == 1 + count);
      for (std::size_t k = 0; k < count; ++k) {
        CHECK(length(found[1 + k].uv - uv[k]) < 1e-6);
        CHECK(length(found[1 + k].position - position_at(uv[k], sag_of(corners))) < 1e-4);
      }
    }
  }
}

TEST_CASE("where no ray of the cell crosses the stop there is no corner") {
  const std::vector<Corner> cell = cell_of(4, 0.0);
  std::vector<Corner> found;
  const std::vector<Vec2> stop{{3.0, 0.0}, stop_at({0.5, 0.5}, 0.0), {0.0, -2.0}};
  IsoparametricCell(cell, kLimits).add_crossing(stop, 0, {0.5, 0.5}, found);
  REQUIRE(found.size() == 1);
  CHECK(length(found[0].uv - Vec2{0.5, 0.5}) < 1e-6);
  // A cell whose corners all cross in one point yields none.
  std::vector<Corner> point = cell;
  for (Corner& c : point) c.limit = cell[0].limit;
  found.clear();
  IsoparametricCell(point, kLimits).add_crossing(stop, 0, {0.5, 0.5}, found);
  CHECK(found.empty());
}
