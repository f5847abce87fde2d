// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include "render/reference/flux_image.h"
#include "support/approx.h"

using contrejour::Vec2;
using contrejour::reference::FluxImage;

namespace {

std::vector<double> pixels_of(const FluxImage& image, int width, int height) {
  std::vector<double> rgb(static_cast<std::size_t>(width * height * 3));
  image.add_to(rgb, {1.0, 0.0, 0.0});
  std::vector<double> flux;
  for (std::size_t k = 0; k < rgb.size(); k += 3) flux.push_back(rgb[k]);
  return flux;
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

}  // namespace

TEST_CASE("every pixel gets the fraction of the polygon it covers") {
  FluxImage image(4, 4);
  const std::array<Vec2, 4> box{Vec2{0.5, 1.0}, Vec2{2.5, 1.0}, Vec2{2.5, 2.0}, Vec2{0.5, 2.0}};
  image.add_polygon(box, 8.0);
  const auto p = pixels_of(image, 4, 4);
  CHECK(p[4] == contrejour::test::approx(2.0));
  CHECK(p[5] == contrejour::test::approx(4.0));
  CHECK(p[6] == contrejour::test::approx(2.0));
  CHECK(sum(p) == contrejour::test::approx(8.0));
}

TEST_CASE("a triangle's coverage agrees with counting sub-pixel points") {
  const std::array<Vec2, 3> t{Vec2{0.3, 0.2}, Vec2{5.1, 1.7}, Vec2{2.2, 4.9}};
  FluxImage image(6, 6);
  image.add_polygon(t, 1.0);
  const auto p = pixels_of(image, 6, 6);
  constexpr int kSub = 200;
  std::vector<double> counted(36);
  const auto side = [](Vec2 a, Vec2 b, Vec2 q) { return cross(b - a, q - a); };
  for (int y = 0; y < 6 * kSub; ++y) {
    for (int x = 0; x < 6 * kSub; ++x) {
      const Vec2 q{(x + 0.5) / kSub, (y + 0.5) / kSub};
      if (side(t[0], t[1], q) > 0 && side(t[1], t[2], q) > 0 && side(t[2], t[0], q) > 0) {
        counted[static_cast<std::size_t>(y / kSub * 6 + x / kSub)] += 1.0;
      }
    }
  }
  const double total = sum(counted);
  for (std::size_t k = 0; k < 36; ++k)
    CHECK(p[k] == contrejour::test::approx(counted[k] / total).epsilon(0.02).scale(0.01));
}

TEST_CASE("no flux is lost inside the image, whatever the polygon's shape, size or orientation") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> coordinate(2.0, 30.0);
  for (int trial = 0; trial < 3000; ++trial) {
    const double size = std::pow(10.0, -8.0 + trial % 10);
    std::uniform_real_distribution<double> off(-size, size);
    const Vec2 centre{coordinate(random), coordinate(random)};
    const auto inside = [](double v) { return std::min(32.0, std::max(0.0, v)); };
    std::array<Vec2, 3> t;
    for (Vec2& p : t) p = {inside(centre.x + off(random)), inside(centre.y + off(random))};
    if (trial % 5 == 0) t[2] = t[0] + (t[1] - t[0]) * 0.3;  // without area
    FluxImage image(32, 33);
    image.add_polygon(t, 1.0);
    CHECK(sum(pixels_of(image, 32, 33)) == contrejour::test::approx(1.0).epsilon(1e-6));
  }
}

TEST_CASE("what falls outside is lost, and only that") {
  FluxImage image(10, 10);
  const std::array<Vec2, 4> box{Vec2{-5.0, 2.0}, Vec2{5.0, 2.0}, Vec2{5.0, 4.0}, Vec2{-5.0, 4.0}};
  image.add_polygon(box, 1.0);
  const std::array<Vec2, 3> far{Vec2{1e9, 1e9}, Vec2{2e9, 1e9}, Vec2{1e9, 3e9}};
  image.add_polygon(far, 1.0);
  CHECK(sum(pixels_of(image, 10, 10)) == contrejour::test::approx(0.5));
}
