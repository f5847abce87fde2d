// SPDX-License-Identifier: Apache-2.0
// Ghosts of a few pixels: found on the line through the optical centre, and fitted beside larger ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/fit_flare.h"
#include "measure/find/find_small_ghosts.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr double kSpotFocalLength_px = 120.0;
constexpr int kSpotWidth = 120, kSpotHeight = 60;

MeasuredGhost spot_disc(double speed, double radius_px, double level) {
  MeasuredGhost ghost;
  ghost.centre.coefficients = {speed, 0.0};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {radius_px / kSpotFocalLength_px};
  ghost.width_in.coefficients = ghost.width_out.coefficients = {0.3 / kSpotFocalLength_px};
  for (std::size_t c = 0; c < 3; ++c) ghost.border[c].coefficients = ghost.inside[c].coefficients = {level};
  ghost.last = 0.4;
  return ghost;
}

// A wide dim disc with a spot on it, and a spot by itself.
MeasuredFlare flare_with_spots() {
  MeasuredFlare flare{"spots", "", 0.4, std::nullopt, {}};
  flare.ghosts = {spot_disc(-0.5, 14.0, 0.4), spot_disc(-0.62, 2.0, 4.0), spot_disc(0.55, 3.0, 3.0)};
  return flare;
}

const TangentFrame kSpotFrame{kSpotWidth, kSpotHeight, kSpotFocalLength_px, {58.6, 30.7}};

Image picture_of_spots(const MeasuredFlare& flare, double s, unsigned seed, double deviation) {
  const FlareLight light{{s, 0.0}, {1.0, 1.0, 1.0}};
  Image picture = *render_measured(flare, std::span(&light, 1), kSpotFrame);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  for (float& value : picture.pixels) value += static_cast<float>(normal(random));
  return picture;
}

FlareSweep sweep_of_spots(const MeasuredFlare& flare, double deviation) {
  FlareSweep sweep;
  for (int k = -5; k <= 5; ++k) sweep.angles_rad.push_back(std::atan(0.4 / 5.0 * k));
  sweep.picture = [=, angles = sweep.angles_rad](std::size_t k) -> Result<CapturedImage> {
    const Image picture = picture_of_spots(flare, std::tan(angles[k]), static_cast<unsigned>(k) + 1, deviation);
    CapturedImage image{picture, Image(kSpotWidth, kSpotHeight), Image(kSpotWidth, kSpotHeight, 1), {}};
    for (float& v : image.variance.pixels) v = static_cast<float>(deviation * deviation);
    for (float& v : image.valid.pixels) v = 1.0F;
    return image;
  };
  return sweep;
}

const double kSpotNoise = 0.02 * 0.4 / (kSpotFocalLength_px * kSpotFocalLength_px);  // a fiftieth of the dim disc

}  // namespace

TEST_CASE("small ghosts: a spot is found where it is, and where there is none, no place stands out as much") {
  const MeasuredFlare flare = flare_with_spots();
  double least_contrast = 1e9;
  for (const auto& [ghosts, speed] :
       {std::pair{std::vector{flare.ghosts[0], flare.ghosts[1]}, -0.62}, std::pair{std::vector{flare.ghosts[2]}, 0.55},
        std::pair{std::vector<MeasuredGhost>(), 0.0}}) {
    std::vector<SearchPicture> pictures;
    for (int k = 1; k <= 9; ++k) {
      const double s = 0.4 / 9.0 * k;
      const MeasuredFlare shown{"", "", 0.4, std::nullopt, ghosts};
      FitStation station{s,
                         {kSpotFrame, {1.0, 0.0}},
                         picture_of_spots(shown, s, static_cast<unsigned>(k), kSpotNoise),
                         Image(kSpotWidth, kSpotHeight)};
      for (float& w : station.weight.pixels) w = static_cast<float>(1.0 / (kSpotNoise * kSpotNoise));
      pictures.push_back(search_pictures(std::span(&station, 1), kSpotNoise)[0]);
    }
    const auto found = strongest_spot(pictures, {}, {}, {});
    if (ghosts.empty()) {
      CHECK((!found || found->contrast < 0.2 * least_contrast));
      continue;
    }
    REQUIRE(found.has_value());
    const double s = 0.3;
    CHECK(std::abs((found->speed + found->bend * s * s - speed) * s) * kSpotFocalLength_px < 1.0);
    least_contrast = std::min(least_contrast, found->contrast);
  }
}

TEST_CASE("small ghosts: a spot that saturates one channel is found by the others") {
  const MeasuredFlare flare{"", "", 0.4, std::nullopt, {flare_with_spots().ghosts[2]}};
  std::vector<FitStation> stations;
  for (int k = 1; k <= 9; ++k) {
    const double s = 0.4 / 9.0 * k;
    FitStation station{s,
                       {kSpotFrame, {1.0, 0.0}},
                       picture_of_spots(flare, s, static_cast<unsigned>(k), kSpotNoise),
                       Image(kSpotWidth, kSpotHeight)};
    for (std::size_t i = 0; i < station.weight.pixels.size(); ++i) {
      const bool saturated = i % 3 == 2 && static_cast<double>(station.rate.pixels[i]) > 5.0 * kSpotNoise;
      if (saturated) station.rate.pixels[i] = 0.0F;  // as where no exposure shows a pixel
      station.weight.pixels[i] = saturated ? 0.0F : static_cast<float>(1.0 / (kSpotNoise * kSpotNoise));
    }
    stations.push_back(std::move(station));
  }
  const auto found = strongest_spot(search_pictures(stations, kSpotNoise), {}, {}, {});
  REQUIRE(found.has_value());
  const double s = 0.3;
  CHECK(std::abs((found->speed + found->bend * s * s - 0.55) * s) * kSpotFocalLength_px < 1.0);
}

TEST_CASE("small ghosts: a channel that a spot saturates gets a level near that of the others [slow]") {
  const MeasuredFlare flare{"", "", 0.4, std::nullopt, {spot_disc(0.55, 1.6, 3.0)}};
  FlareSweep sweep = sweep_of_spots(flare, kSpotNoise);
  const float most = static_cast<float>(0.1 * 3.0 / (kSpotFocalLength_px * kSpotFocalLength_px));
  std::size_t saturated = 0;
  sweep.picture = [&saturated, most, whole = sweep.picture](std::size_t k) -> Result<CapturedImage> {
    Result<CapturedImage> image = whole(k);
    image->valid = Image(kSpotWidth, kSpotHeight);
    for (std::size_t i = 0; i < image->rate.pixels.size(); ++i) {
      const bool is_lost = i % 3 == 2 && image->rate.pixels[i] > most;
      image->valid.pixels[i] = is_lost ? 0.0F : 1.0F;
      if (is_lost) image->rate.pixels[i] = most;
      saturated += is_lost ? 1 : 0;
    }
    return image;
  };
  FlareFitOptions options;
  options.max_ghosts = 0;
  options.max_small_ghosts = 1;
  const SweepGeometry geometry{kSpotFrame.centre_px, kSpotFocalLength_px, 0.0, 0.0, 0.0, 0.0, {}};
  const auto fit = fit_flare(sweep, geometry, options, {.threads = 1});
  REQUIRE_MESSAGE(fit.has_value(), fit.error().to_string());
  CHECK(saturated > 50);
  REQUIRE(fit->flare.ghosts.size() >= 2);
  MeasuredFlare alone = fit->flare;
  alone.ghosts = {fit->flare.ghosts[1]};
  for (const double s : {0.1, 0.2, 0.3}) {
    Rgb flux{};
    const Image drawn = picture_of_spots(alone, s, 1, 0.0);
    for (std::size_t i = 0; i < drawn.pixels.size(); ++i) flux[i % 3] += static_cast<double>(drawn.pixels[i]);
    CHECK(flux[2] == test::approx(flux[0]).epsilon(0.4));
  }
}

TEST_CASE("small ghosts: a fit finds two spots, and their speeds, sizes and levels, with a disc below them [slow]") {
  FlareFitOptions options;
  options.max_ghosts = 1;
  options.max_small_ghosts = 2;
  const SweepGeometry geometry{kSpotFrame.centre_px, kSpotFocalLength_px, 0.0, 0.0, 0.0, 0.0, {}};
  const auto fit = fit_flare(sweep_of_spots(flare_with_spots(), kSpotNoise), geometry, options);
  REQUIRE_MESSAGE(fit.has_value(), fit.error().to_string());
  REQUIRE(fit->found.size() == 3);  // the veil comes before them, diffuse ghosts after them
  REQUIRE(fit->flare.ghosts.size() >= 4);
  const double s = 0.3;
  for (const auto& [speed, radius_px, flux] : {std::array{-0.62, 2.0, 4.0 * 4.0}, std::array{0.55, 3.0, 3.0 * 9.0}}) {
    bool is_found = false;
    for (std::size_t k = 2; k <= 3; ++k) {
      const MeasuredGhost& ghost = fit->flare.ghosts[k];
      if (std::abs(ghost.centre(s) - speed * s) * kSpotFocalLength_px > 0.2) continue;
      is_found = true;
      MeasuredFlare alone = fit->flare;
      alone.ghosts = {ghost};
      double sum = 0.0;
      for (const float v : picture_of_spots(alone, s, 1, 0.0).pixels) sum += static_cast<double>(v) / 3.0;
      const double expected = 3.141592653589793 * flux / (kSpotFocalLength_px * kSpotFocalLength_px);
      CHECK(sum == test::approx(expected).epsilon(0.3));
      CHECK(ghost.half_height(s) * kSpotFocalLength_px == test::approx(radius_px).epsilon(0.2));
    }
    CHECK_MESSAGE(is_found, write_flare(fit->flare));
  }
  options.max_small_ghosts = 0;
  const auto without = fit_flare(sweep_of_spots(flare_with_spots(), kSpotNoise), geometry, options);
  REQUIRE(without.has_value());
  CHECK(fit->nrmse < 0.5 * without->nrmse);
  CHECK(fit->held_out_nrmse < 0.5 * without->held_out_nrmse);
}
