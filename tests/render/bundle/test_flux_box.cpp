// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "render/bundle/flux_box.h"
#include "support/approx.h"

using namespace contrejour;
using bundle::FluxBox;
using bundle::PixelBox;

namespace {

double total(const FluxBox& box) {
  double sum = 0.0;
  for (int y = box.box().y0; y < box.box().y1; ++y) {
    for (const float f : box.row(y)) sum += f;
  }
  return sum;
}

double at(const FluxBox& box, int x, int y) { return box.row(y)[static_cast<std::size_t>(x - box.box().x0)]; }

std::vector<Vec2> ellipse(Vec2 middle, Vec2 radius, double rotation, int corners) {
  std::vector<Vec2> p;
  for (int k = 0; k < corners; ++k) {
    const double a = 2.0 * std::numbers::pi * k / corners;
    const Vec2 q{radius.x * std::cos(a), radius.y * std::sin(a)};
    p.push_back(middle + Vec2{q.x * std::cos(rotation) - q.y * std::sin(rotation),
                              q.x * std::sin(rotation) + q.y * std::cos(rotation)});
  }
  return p;
}

bool inside(const std::vector<Vec2>& polygon, Vec2 p) {
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k];
    if (cross(polygon[(k + 1) % polygon.size()] - a, p - a) < 0.0) return false;
  }
  return true;
}

// The fraction of a pixel that a polygon covers, from 64 x 64 points.
double sampled(const std::vector<Vec2>& polygon, int x, int y) {
  constexpr int kPoints = 64;
  int hits = 0;
  for (int k = 0; k < kPoints * kPoints; ++k) {
    hits += inside(polygon, {x + (k % kPoints + 0.5) / kPoints, y + (k / kPoints + 0.5) / kPoints}) ? 1 : 0;
  }
  return static_cast<double>(hits) / (kPoints * kPoints);
}

}  // namespace

TEST_CASE("every pixel gets the fraction of the polygon that covers it") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int k = 0; k < 60; ++k) {
    FluxBox box(PixelBox{3, 2, 15, 12});
    const auto polygon = ellipse({3.0 + 12 * unit(random), 2.0 + 10 * unit(random)},
                                 {0.05 + 4 * unit(random), 0.05 + 4 * unit(random)}, 6 * unit(random), 3 + k % 6);
    auto rotated = polygon;
    if (k % 2 == 1) std::reverse(rotated.begin(), rotated.end());
    box.add_polygon(rotated, {{0.0, 0.0}, 2.0, {}});
    for (int y = 2; y < 12; ++y) {
      for (int x = 3; x < 15; ++x)
        CHECK(at(box, x, y) == test::approx(2.0 * sampled(polygon, x, y)).epsilon(0.02).scale(1.0));
    }
  }
}

TEST_CASE("a polygon larger than the coverage buffer, and than the frame, is exact as well") {
  FluxBox box(PixelBox{0, 0, 300, 200});
  box.add_polygon(ellipse({150, 100}, {90, 70}, 0.3, 40), {{150, 100}, 1.0, {0.001, 0.0}});
  const double area = 0.5 * 40 * std::sin(2 * std::numbers::pi / 40) * 90 * 70;
  CHECK(total(box) == test::approx(area).epsilon(1e-5));
  CHECK(at(box, 200, 100) == test::approx(1.0505).epsilon(1e-5));

  FluxBox all(PixelBox{0, 0, 300, 200});
  all.add_polygon(ellipse({150, 100}, {1e5, 1e5}, 0.3, 6), {{0, 0}, 1.0, {}});
  CHECK(total(all) == test::approx(60000.0).epsilon(1e-6));
}

TEST_CASE("neighbours that share edges leave neither gaps nor doubled pixels") {
  FluxBox box(PixelBox{0, 0, 40, 40});
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.3, 0.3);
  std::array<std::array<Vec2, 31>, 31> net;
  for (int y = 0; y <= 30; ++y) {
    for (int x = 0; x <= 30; ++x) {
      net[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] = {1.37 * x - 0.4 + off(random),
                                                                       1.41 * y - 0.4 + off(random)};
    }
  }
  for (std::size_t y = 0; y < 30; ++y) {
    for (std::size_t x = 0; x < 30; ++x) {
      const std::array<Vec2, 4> q{net[y][x], net[y][x + 1], net[y + 1][x + 1], net[y + 1][x]};
      box.add_polygon(std::array{q[0], q[1], q[2]}, {{0, 0}, 1.0, {}});
      box.add_polygon(std::array{q[0], q[2], q[3]}, {{0, 0}, 1.0, {}});
    }
  }
  for (int y = 1; y < 39; ++y) {
    for (int x = 1; x < 39; ++x) CHECK(at(box, x, y) == test::approx(1.0).epsilon(2e-6));
  }
}

TEST_CASE("a line spreads its flux by length and loses what leaves the frame") {
  FluxBox box(PixelBox{0, 0, 10, 10});
  box.add_line({0.5, 0.5}, {8.5, 0.5}, 8.0);
  CHECK(at(box, 0, 0) == test::approx(0.5));
  CHECK(at(box, 3, 0) == test::approx(1.0));
  CHECK(total(box) == test::approx(8.0));
  box.add_line({-5.0, 9.0}, {5.0, -1.0}, 2.0);
  CHECK(total(box) == test::approx(8.0 + 2.0 * 0.4));
  box.add_line({4.0, 4.0}, {4.0, 9.0}, 1.0);   // along a border of pixels
  box.add_line({7.3, 7.3}, {7.3, 7.3}, 0.0);
  CHECK(total(box) == test::approx(9.8));
  box.add_line({1e6, 3.0}, {-1e6, 3.5}, 2e6);
  CHECK(total(box) == test::approx(19.8).epsilon(1e-4));
}
