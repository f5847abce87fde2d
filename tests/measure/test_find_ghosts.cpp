// SPDX-License-Identifier: Apache-2.0
// Discs that move with the light, planted in pictures of noise.
#include <cmath>
#include <random>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "measure/find/find_ghosts.h"

using namespace contrejour;

namespace {

constexpr double kDiscFocalLength_px = 150.0, kDiscRange = 0.4;
constexpr int kDiscStations = 14;

struct PlantedDisc {
  double speed = 0, radius_px = 0, step = 0;  // step: standard deviations
  double from = 0;                            // of the range: hidden nearer to the axis
};

SearchPicture picture_with(std::span<const PlantedDisc> discs, double s, unsigned seed) {
  SearchPicture picture;
  picture.s = s;
  picture.frame.pixels = {130, 90, kDiscFocalLength_px, {64.2, 45.7}};
  picture.value = Image(130, 90, 1);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, 1.0F);
  for (int y = 0; y < picture.value.height; ++y) {
    for (int x = 0; x < picture.value.width; ++x) {
      float& value = picture.value.at(x, y);
      value = noise(random);
      for (const PlantedDisc& disc : discs) {
        const Vec2 offset = Vec2{x + 0.5, y + 0.5} - picture.frame.pixels.centre_px;
        const double r = std::hypot(offset.x - disc.speed * s * kDiscFocalLength_px, offset.y);
        if (r < disc.radius_px && s >= disc.from * kDiscRange) value += static_cast<float>(disc.step);
      }
    }
  }
  return picture;
}

std::vector<SearchPicture> pictures_with(std::span<const PlantedDisc> discs) {
  std::vector<SearchPicture> pictures;
  for (int k = 1; k <= kDiscStations; ++k)
    pictures.push_back(picture_with(discs, kDiscRange * k / kDiscStations, static_cast<unsigned>(k)));
  return pictures;
}

bool is_planted(const FoundGhost& found, const PlantedDisc& disc) {
  const double s = kDiscRange;
  return std::abs(found.speed + found.bend * s * s - disc.speed) * s * kDiscFocalLength_px < 2.0 &&
         std::abs(found.radius * (1.0 + found.growth * s * s) * kDiscFocalLength_px - disc.radius_px) < 2.0;
}

}  // namespace

TEST_CASE("find ghosts: a disc that something hides at the stations near the axis is found by the others") {
  const PlantedDisc disc{0.6, 14.0, 3.0, 0.4};
  const auto found = strongest_disc(pictures_with(std::span(&disc, 1)), {}, {}, {});
  REQUIRE(found.has_value());
  CHECK(is_planted(*found, disc));
}

TEST_CASE("find ghosts: of discs that overlap, each is found once, and no station's outlier is taken for one") {
  // The third is as bright as both others together, but at the last two stations only.
  const std::vector<PlantedDisc> discs{{-0.5, 20.0, 4.0, 0.0}, {-0.2, 13.0, 4.0, 0.0}, {0.8, 9.0, 12.0, 0.9}};
  const std::vector<SearchPicture> pictures = pictures_with(discs);
  std::vector<FoundGhost> known;
  for (int k = 0; k < 2; ++k) {
    const auto found = strongest_disc(pictures, {}, known, {});
    REQUIRE(found.has_value());
    known.push_back(*found);
  }
  CHECK(is_planted(known[0], discs[0]) != is_planted(known[1], discs[0]));
  CHECK(is_planted(known[0], discs[1]) != is_planted(known[1], discs[1]));
}

TEST_CASE("find ghosts: the same for any number of threads") {
  const PlantedDisc disc{0.6, 14.0, 3.0, 0.0};
  const std::vector<SearchPicture> pictures = pictures_with(std::span(&disc, 1));
  const auto one = strongest_disc(pictures, {}, {}, {.threads = 1});
  const auto three = strongest_disc(pictures, {}, {}, {.threads = 3});
  REQUIRE(one.has_value());
  REQUIRE(three.has_value());
  CHECK(one->speed == three->speed);
  CHECK(one->radius == three->radius);
  CHECK(one->contrast == three->contrast);
}

TEST_CASE("find ghosts: a disc is found although all of the strongest candidates lead to a brighter, known one") {
  const std::vector<PlantedDisc> discs{{-0.6, 26.0, 40.0, 0.0}, {0.9, 9.0, 2.0, 0.0}};
  const std::vector<SearchPicture> pictures = pictures_with(discs);
  std::vector<FoundGhost> known;
  bool found_dim = false;
  for (int k = 0; k < 13 && !found_dim; ++k) {  // parts of the brighter one's edge count as discs, too
    const auto next = strongest_disc(pictures, {}, known, {});
    REQUIRE(next.has_value());
    if (k == 0) CHECK(is_planted(*next, discs[0]));
    found_dim = is_planted(*next, discs[1]);
    known.push_back(*next);
  }
  CHECK(found_dim);
}
