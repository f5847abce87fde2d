// SPDX-License-Identifier: Apache-2.0
// Masks from openings and pictures: areas, points, and refused input.
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/pupil_mask.h"
#include "support/approx.h"

using namespace contrejour;

namespace {
double open_fraction(const PupilMask& mask) {  // amplitude, not power: the area of the opening
  double sum = 0.0;
  for (const float a : mask.amplitude) sum += a;
  return sum * mask.grid.pitch_mm * mask.grid.pitch_mm;
}
}  // namespace

TEST_CASE("a mask's samples add up to the opening's area") {
  for (const Iris& iris : {Iris{}, Iris{6, 0.2}, Iris{5, 0.1, 0.4, 1.05, 0.05, 7}}) {
    const IrisOpening opening(iris);
    for (const int samples : {63, 128, 511}) {
      const PupilMask mask = make_mask(grid_over(3.0, samples), opening, 3.0);
      CHECK(open_fraction(mask) == test::approx(9.0 * opening.area()).epsilon(2e-4));
      CHECK(mask.real());
    }
  }
}

TEST_CASE("an edge's samples are its exact share, at any angle") {
  for (const double angle : {0.0, 0.3, std::numbers::pi / 4, 1.2}) {
    const Vec2 n{std::cos(angle), std::sin(angle)};
    const MaskGrid grid{64, 1.0};
    const PupilMask mask = make_mask(grid, [&](Vec2 p) { return dot(n, p) - 0.37; });
    for (int row = 20; row < 44; ++row) {
      for (int column = 20; column < 44; ++column) {
        const Vec2 centre = grid.position_mm(column, row);
        int inside = 0;
        for (int i = 0; i < 10000; ++i)
          inside += dot(n, centre + Vec2{(i % 100 + 0.5) / 100 - 0.5, (i / 100 + 0.5) / 100 - 0.5}) <= 0.37;
        CHECK(mask.amplitude[static_cast<std::size_t>(row * 64 + column)] ==
              test::approx(inside * 1e-4).epsilon(0.002).scale(1.0));
      }
    }
  }
}

TEST_CASE("a picture stands upright on the stop") {
  Image picture(4, 2, 1);
  picture.at(3, 0) = 0.5F;  // top right
  const PupilMask mask = mask_of_image(picture, 0, 8.0).value();
  CHECK(mask.grid.side == 4);
  CHECK(mask.grid.pitch_mm == 2.0);
  CHECK(mask.amplitude[1 * 4 + 3] == 0.5F);
  CHECK(mask.grid.position_mm(3, 1).x == 3.0);
  CHECK(mask.grid.position_mm(3, 1).y == 1.0);
}

TEST_CASE("pictures that are no aperture are turned away") {
  Image picture(4, 4, 1);
  CHECK_FALSE(mask_of_image(Image(), 0, 1.0).has_value());
  CHECK_FALSE(mask_of_image(picture, 1, 1.0).has_value());
  picture.at(1, 2) = -1.0F;
  CHECK_FALSE(mask_of_image(picture, 0, 1.0).has_value());
  picture.at(1, 2) = std::numeric_limits<float>::quiet_NaN();
  CHECK(mask_of_image(picture, 0, 1.0).error().message.find("1,2") != std::string::npos);
}

TEST_CASE("dirt dims where it lies") {
  Image dirt(2, 2, 1);
  for (float& v : dirt.pixels) v = 1.0F;
  dirt.at(0, 0) = 0.25F;
  const PupilMask clean = make_mask(grid_over(1.0, 100), IrisOpening(Iris{}), 1.0);
  const PupilMask dirty = with_dirt(clean, dirt, 0).value();
  const auto at = [](const PupilMask& m, int x, int y) {
    return m.amplitude[static_cast<std::size_t>(y * m.grid.side + x)];
  };
  CHECK(at(dirty, 25, 25) == test::approx(0.25).epsilon(0.02));
  CHECK(at(dirty, 76, 76) == 1.0F);
  CHECK(at(clean, 25, 25) == 1.0F);
}
