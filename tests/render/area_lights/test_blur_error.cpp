// SPDX-License-Identifier: Apache-2.0
// Estimated errors of coarse pixels and of shared blurs, against discs that are blurred and compared.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "render/area_lights/blur_error.h"
#include "render/area_lights/image_pyramid.h"

using namespace contrejour;
using namespace contrejour::area;

namespace {

constexpr int kSide = 240;

Light disc_light() {
  Light light;
  light.radius_rad = 0.01;
  return light;
}

// A picture of a disc of level 1, whose pixels are fluxes, blurred by a disc and sampled down to the frame.
Image blurred_disc(double radius_px, double blur_px, int level) {
  const Frame frame{kSide, kSide, 0, 0, kSide, kSide, 0.01};
  const LightPiece piece = pieces_of(disc_light()).front();
  const LinearMap map = LinearMap{} * (blur_px / std::tan(0.01) * std::exp2(-level));
  ImagePyramid pyramid(frame);
  const PyramidFrame at = pyramid.frame_for(level, extent_of(piece, map));
  const double scale = std::exp2(level);
  const Vec2 middle{(0.5 * kSide + 0.3) / scale - at.left, (0.5 * kSide - 0.2) / scale - at.top};
  Image picture(at.frame.width, at.frame.height);
  constexpr int kFine = 16;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      int inside = 0;
      for (int k = 0; k < kFine * kFine; ++k) {
        const Vec2 p{x + (k % kFine + 0.5) / kFine, y + (k / kFine + 0.5) / kFine};
        if (length(p - middle) * scale < radius_px) ++inside;
      }
      for (int c = 0; c < 3; ++c) picture.at(x, y, c) = static_cast<float>(scale * scale * inside / (kFine * kFine));
    }
  }
  pyramid.add({picture}, at, make_kernel(piece, map, at.moved), 0.0, {});
  return std::move(pyramid).flattened({});
}

double squares(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t k = 1; k < a.pixels.size(); k += 3) sum += std::pow(a.pixels[k] - b.pixels[k], 2);
  return sum;
}

BlurredGhost ghost_of(double radius_px, double blur_px) { return {{blur_px, blur_px}, {radius_px, radius_px}, 1.0}; }

}  // namespace

TEST_CASE("coarse pixels cost about what is foreseen [slow]") {
  for (const auto& [blur, level] : {std::pair{6.0, 1}, {6.0, 2}, {12.0, 2}, {12.0, 3}}) {
    CAPTURE(blur);
    CAPTURE(level);
    const double made = squares(blurred_disc(50.0, blur, level), blurred_disc(50.0, blur, 0));
    const double foreseen = level_error(ghost_of(50.0, blur), level);
    CHECK(made < 2.0 * foreseen);
    CHECK(made > 0.1 * foreseen);
  }
}

TEST_CASE("another ghost's blur costs about what is foreseen [slow]") {
  for (const double other : {9.0, 11.0, 14.0}) {
    const double made = squares(blurred_disc(50.0, other, 0), blurred_disc(50.0, 10.0, 0));
    const double foreseen = 2.0 * kPi * (50.0 + 10.0) * misfit_error(1.0, 10.0, std::abs(other - 10.0));
    CHECK(made < 2.0 * foreseen);
    CHECK(made > 0.3 * foreseen);
  }
}

TEST_CASE("a spot loses its place in pixels wider than it, and so does a line") {
  const BlurredGhost spot{{1.3, 1.3}, {0.3, 0.3}, 0.4}, line{{1.3, 1.3}, {0.3, 3.0}, 0.4},
      disc{{1.3, 1.3}, {2.0, 3.0}, 0.4};
  CHECK(spot_error(spot, 0) > 0.1);
  CHECK(spot_error(line, 0) >= spot_error(spot, 0));
  CHECK(spot_error(disc, 0) < 1e-6);
  CHECK(spot_error(line, -1) < 0.1 * spot_error(line, 0));
  CHECK(spot_level(line, 0, 0.01) < 0);
  CHECK(spot_level(disc, 0, 0.01) == 0);
}

TEST_CASE("levels are coarser for the dark, and only as far as allowed") {
  std::vector<BlurredGhost> ghosts;
  for (const double level : {1.0, 0.1, 0.01, 1e-4}) ghosts.push_back({{12.0, 12.0}, {80.0, 80.0}, level});
  const std::vector<int> safe = levels_of(ghosts, 0.0);
  CHECK(std::ranges::all_of(safe, [&](int level) { return level == safe.front(); }));
  const std::vector<int> some = levels_of(ghosts, 0.5);
  CHECK(std::ranges::is_sorted(some));
  CHECK(some.back() > safe.back());
  double sum = 0.0;
  for (std::size_t k = 0; k < ghosts.size(); ++k)
    if (some[k] > safe[k]) sum += level_error(ghosts[k], some[k]);
  CHECK(sum <= 0.5);
  // A small spot has the light's outline.
  CHECK(levels_of(std::vector<BlurredGhost>{{{12.0, 12.0}, {0.5, 0.5}, 1.0}}, 0.5).front() < some.front());
  // No ghosts, and invalid sizes.
  CHECK(levels_of({}, 1.0).empty());
  for (const BlurredGhost& strange :
       {BlurredGhost{}, BlurredGhost{{1e9, 1e9}, {1e9, 1e9}, 1e9}, BlurredGhost{{1.0, 1e9}, {0.0, 0.0}, 0.0}}) {
    const int level = levels_of(std::vector<BlurredGhost>{strange}, 1.0).front();
    CHECK(level >= 0);
    CHECK(level < kLevels);
    CHECK(std::isfinite(level_error(strange, level)));
  }
}
