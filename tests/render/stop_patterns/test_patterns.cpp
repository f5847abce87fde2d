// SPDX-License-Identifier: Apache-2.0
// Patterns over the stop: means, reach, and several together.
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "render/polygons/packed_irradiance.h"
#include "render/stop_patterns/band_texture.h"
#include "render/stop_patterns/resampled.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::stop_patterns;
using namespace contrejour::raster;

namespace {

// A bright disc surrounded by a dim one.
PatternTexture two_discs(double extent, double inner, double outer, float dim) {
  constexpr int kSide = 128;
  std::vector<float> samples;
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const double r = std::hypot(column + 0.5 - 0.5 * kSide, row + 0.5 - 0.5 * kSide) * 2.0 * extent / kSide;
      samples.push_back(r < inner ? 1.0F : r < outer ? dim : 0.0F);
    }
  return {kSide, extent, samples};
}

}  // namespace

TEST_CASE("a texture's mean over a square, wide or not, and nothing outside") {
  std::vector<float> ramp;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 64; ++column) ramp.push_back(static_cast<float>(column));
  const PatternTexture texture(64, 2.0, ramp);  // 16 a stop radius
  for (const double width : {0.0, 0.1, 0.5}) CHECK(texture.at({0.3, -0.2}, width) == test::approx(31.5 + 4.8));
  CHECK(texture.at({2.1, 0.0}, 0.0) == 0.0);
  CHECK(texture.flux() == test::approx(31.5 * 16.0));
}

TEST_CASE("a pattern reaches as far as it is bright, and what lies beyond is known") {
  const PatternTexture discs = two_discs(2.0, 0.8, 1.5, 0.002F);
  CHECK(discs.radius_above(0.01) == test::approx(0.8).epsilon(0.06));
  CHECK(discs.radius_above(0.001) == test::approx(1.5).epsilon(0.03));
  const double area = std::numbers::pi * (1.5 * 1.5 - 0.8 * 0.8);
  CHECK(discs.squared_beyond(0.85) == test::approx(0.002 * 0.002 * area).epsilon(0.1));
  CHECK(discs.squared_beyond(1.6) == 0.0);
  // Light whose loss would matter is kept, however dim.
  CHECK(two_discs(2.0, 0.8, 1.5, 0.05F).radius_above(0.2) > 1.4);
}

TEST_CASE("lines about a pattern: all that is bright is within them, and little else") {
  constexpr int kSide = 128;
  constexpr double kExtent = 2.0;
  std::vector<float> bar;  // across the middle, brighter to the right
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column) {
      const Vec2 p{(column + 0.5) * 2.0 * kExtent / kSide - kExtent, kExtent - (row + 0.5) * 2.0 * kExtent / kSide};
      bar.push_back(std::abs(p.x) < 1.5 && std::abs(p.y) < 0.4 ? (p.x > 0.0 ? 1.0F : 0.05F) : 0.0F);
    }
  const PatternTexture texture(kSide, kExtent, bar);
  const auto far = [](const BoundingPolygon& bounding_polygon, Vec2 to) {
    double distance = 10.0;  // the largest distance from the middle within all lines
    for (std::size_t k = 0; k < BoundingPolygon::kLines; ++k)
      if (dot(BoundingPolygon::normals()[k], to) > 1e-9)
        distance = std::min(distance, bounding_polygon.distance(k) / dot(BoundingPolygon::normals()[k], to));
    return distance;
  };
  const BoundingPolygon all = texture.bounding_polygon_above(0.01, 1.0),
                        bright = texture.bounding_polygon_above(0.2, 1.0);
  for (const auto& bounding_polygon : {all, bright}) {
    CHECK(far(bounding_polygon, {1.0, 0.0}) == test::approx(1.5).epsilon(0.1));
    CHECK(far(bounding_polygon, {0.0, 1.0}) < 0.7);
    for (const double y : {-0.38, 0.0, 0.38}) CHECK_FALSE(bounding_polygon.excludes({1.48, y}, 0.0));
  }
  CHECK(far(all, {-1.0, 0.0}) == test::approx(1.5).epsilon(0.1));
  CHECK(far(bright, {-1.0, 0.0}) < 0.6);
  CHECK(texture.bounding_polygon_above(0.2, 1e-4).distance(12) > 1.4);  // light whose loss would matter is kept
  CHECK(bright.excludes({-1.3, 0.0}, 0.2));
  CHECK_FALSE(bright.excludes({-1.3, 0.0}, 1.4));
  CHECK(texture.brightest_beyond(1.0) == test::approx(1.0));
  CHECK(texture.brightest_beyond(1.8) == 0.0);
  BoundingPolygon both = bright;
  both.include(Vec2{-1.9, 0.0});
  CHECK_FALSE(both.excludes({-1.85, 0.0}, 0.0));
}

TEST_CASE("a picture on another grid is what the texture says there") {
  std::vector<float> waves;
  for (int row = 0; row < 48; ++row)
    for (int column = 0; column < 48; ++column)
      waves.push_back(static_cast<float>(2.0 + std::sin(0.7 * column) * std::cos(0.9 * row) + 0.01 * row));
  const PatternTexture texture(48, 1.3, waves);
  for (const auto& [side, extent] : {std::pair{48, 1.3}, std::pair{37, 1.1}, std::pair{64, 1.9}}) {
    const auto out = resampled({48, 1.3, waves}, side, extent);
    REQUIRE(out.size() == static_cast<std::size_t>(side * side));
    double worst = 0.0;
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < side; ++column) {
        const Vec2 p{(column + 0.5) * 2.0 * extent / side - extent, extent - (row + 0.5) * 2.0 * extent / side};
        const double value = static_cast<double>(out[static_cast<std::size_t>(row * side + column)]);
        worst = std::max(worst, std::abs(value - texture.at(p, 0.0)));
      }
    CHECK(worst < 2e-5);
  }
}

TEST_CASE("light in 16 bits: to 2^-13 of itself and of a 2^-15 of the largest, and nothing is nothing") {
  for (const float largest : {1.0F, 3.999F, 4.0F, 1e5F, 3e-9F}) {
    const PackedIrradiance coding(largest);
    CHECK(static_cast<double>(coding.none()) <= 0x1.001p-15 * 1.0005 * static_cast<double>(largest));
    CHECK(coding.light(0) == 0.0F);
    CHECK(coding.coded(0.0F) == 0);
    CHECK(coding.coded(-largest) == 0);
    double worst = 0.0;
    for (int k = 0; k <= 4000; ++k) {
      const float light = largest * std::exp2(-0.005F * static_cast<float>(k));
      const double error = static_cast<double>(coding.light(coding.coded(light))) - static_cast<double>(light);
      worst = std::max(worst, std::abs(error) / static_cast<double>(light + coding.none()));
      // The encoding by which a table is read: the bits, shifted and offset.
      const std::int32_t bits = (coding.coded(light) << PackedIrradiance::kShift) + coding.lowest();
      REQUIRE(std::bit_cast<float>(bits) - coding.none() == coding.light(coding.coded(light)));
    }
    CHECK(worst < 0x1.01p-13);
    CHECK(worst > 0x1p-14);  // the mantissa is used in full
  }
  CHECK(PackedIrradiance(0.0F).light(PackedIrradiance(0.0F).coded(0.0F)) == 0.0F);
}

TEST_CASE("a pattern of one wavelength is the texture's, coded") {
  std::vector<float> ramp;
  for (int row = 0; row < 96; ++row)
    for (int column = 0; column < 96; ++column) ramp.push_back(static_cast<float>(0.02 * column * row));
  const PatternTexture texture(96, 1.5, ramp);
  PatternAtlas atlas;
  const BandTexture band(texture_table(std::array{&texture}), atlas);
  CHECK(band.of_one());
  const TextureTable& table = atlas.texture(band.index());
  const TextureTable::Level& level = table.levels[band.level_for(0.0)];
  REQUIRE(table.levels[1].first == 98 * 98);
  CHECK(table.samples.empty());
  for (const int row : {0, 20, 95})
    for (const int column : {0, 48, 95}) {
      const auto at = static_cast<std::size_t>((row + 1) * level.pitch() + column + 1);
      const double sample = static_cast<double>(ramp[static_cast<std::size_t>(96 * row + column)]);
      CHECK(static_cast<double>(PackedIrradiance::of_lowest(level.lowest).light(table.pairs[at].here)) ==
            test::approx(sample).epsilon(1.3e-4));
    }
  CHECK(table.pairs.front().here == 0);
  CHECK(static_cast<double>(band.brightest({1.4, -1.4}, 0.01)) == test::approx(0.02 * 93 * 93).epsilon(0.03));
}

TEST_CASE("about a square so wide that it is all of a pattern, it is as bright as that is") {
  constexpr int kSide = 48;  // halved down to 3
  std::vector<float> samples(kSide * kSide);
  for (int row = 20; row < 28; ++row)
    for (int column = 20; column < 28; ++column) samples[static_cast<std::size_t>(row * kSide + column)] = 1.0F;
  const PatternTexture texture(kSide, 3.0, samples);
  PatternAtlas atlas;
  const BandTexture pattern(texture_table(std::array{&texture}), atlas);
  const double mean = 64.0 / 256.0;  // over the middle one of 3 x 3
  for (const Vec2 point : {Vec2{-2.5, -0.5}, Vec2{0.8, -2.4}, Vec2{0.0, 0.0}, Vec2{9.0, 9.0}})
    for (const double distance : {2.1, 3.0, 20.0})
      CHECK(pattern.brightest(point, distance) == test::approx(mean).epsilon(1e-3));
  CHECK(pattern.brightest({-2.5, -0.5}, 0.2) < 1e-4);
  CHECK(pattern.brightest({0.1, 0.1}, 0.2) > 0.9);
}

TEST_CASE("patterns side by side are each what they are alone") {
  std::vector<float> ramp;
  for (int row = 0; row < 96; ++row)
    for (int column = 0; column < 96; ++column) ramp.push_back(static_cast<float>(1.0 + 0.01 * column - 0.02 * row));
  const PatternTexture small(96, 1.5, ramp), large(96, 3.0, ramp);
  const std::array<const PatternTexture*, 2> parts{&small, &large};
  PatternAtlas atlas;
  const BandTexture band(texture_table(parts), atlas);
  const TextureTable& table = atlas.texture(band.index());
  CHECK(table.extent == 3.0);
  const TextureTable::Level& level = table.levels[band.level_for(0.0)];
  REQUIRE(level.side == 96);
  for (const int row : {0, 20, 47, 60, 95}) {
    for (const int column : {0, 30, 48, 66, 95}) {
      const Vec2 p{(column + 0.5) / 16.0 - 3.0, 3.0 - (row + 0.5) / 16.0};
      const float* const at =
          &table.samples[static_cast<std::size_t>((row + 1) * level.pitch() + column + 1) * TextureTable::kStride];
      CHECK(static_cast<double>(at[0]) == test::approx(small.at(p, 0.0)).epsilon(1e-5).scale(1.0));
      CHECK(static_cast<double>(at[1]) == test::approx(large.at(p, 0.0)).epsilon(1e-5).scale(1.0));
      CHECK(at[2] == 0.0F);
    }
  }
  CHECK(table.levels[band.level_for(0.5)].side == 24);  // 8 samples wide over the root of 3: halved twice
  CHECK(band.brightest({2.9, -2.9}, 0.05) > 0.0F);
  CHECK(band.brightest({0.0, 0.0}, 1e9) > 0.0F);
  CHECK(band.brightest({50.0, 0.0}, 0.01) >= 0.0F);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();  // points of rays that fail
  CHECK(band.brightest({kNone, kNone}, 0.01) >= 0.0F);
  CHECK(band.brightest({0.0, -0.1}, kNone) > 0.0F);
}
