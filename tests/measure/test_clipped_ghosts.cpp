// SPDX-License-Identifier: Apache-2.0
// Ghosts that a circle cuts, found by a fit.
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/fit_flare.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr TangentFrame kCutFrame{150, 80, 150.0, {74.6, 40.7}};
constexpr double kCutRange = 0.45;

// A disc of 20 pixels that a circle a fifth larger cuts from the left.
MeasuredFlare flare_with_cut_disc() {
  MeasuredGhost ghost;
  ghost.centre.coefficients = {-0.6};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {0.13};
  ghost.width_in.coefficients = ghost.width_out.coefficients = {0.002};
  for (std::size_t c = 0; c < 3; ++c) ghost.border[c].coefficients = ghost.inside[c].coefficients = {1.0};
  ghost.clip_centre.coefficients = {-0.25};
  ghost.clip_radius.coefficients = {0.16};
  ghost.last = kCutRange;
  return {"cut", "", kCutRange, std::nullopt, {ghost}};
}

FlareSweep sweep_of_cut_disc(const MeasuredFlare& flare, double deviation) {
  FlareSweep sweep;
  for (int k = -7; k <= 7; ++k) sweep.angles_rad.push_back(std::atan(kCutRange / 7.0 * k));
  sweep.picture = [=, angles = sweep.angles_rad](std::size_t k) -> Result<CapturedImage> {
    const FlareLight light{{std::tan(angles[k]), 0.0}, {1.0, 1.0, 1.0}};
    CapturedImage image{
        *render_measured(flare, std::span(&light, 1), kCutFrame), Image(150, 80), Image(150, 80, 1), {}};
    std::mt19937 random(static_cast<unsigned>(k) + 1);
    std::normal_distribution<double> normal(0.0, deviation);
    for (float& v : image.rate.pixels) v += static_cast<float>(normal(random));
    for (float& v : image.variance.pixels) v = static_cast<float>(deviation * deviation);
    for (float& v : image.valid.pixels) v = 1.0F;
    return image;
  };
  return sweep;
}

}  // namespace

TEST_CASE("clipped ghosts: a fit finds the circle that cuts a disc, and the disc's own size [slow]") {
  const MeasuredFlare truth = flare_with_cut_disc();
  FlareFitOptions options;
  options.max_ghosts = 1;
  options.max_small_ghosts = 0;
  const SweepGeometry geometry{kCutFrame.centre_px, kCutFrame.focal_length_px, 0.0, 0.0, 0.0, 0.0, {}};
  const auto fit = fit_flare(sweep_of_cut_disc(truth, 2e-7), geometry, options);
  REQUIRE_MESSAGE(fit.has_value(), fit.error().to_string());
  REQUIRE(fit->found.size() == 1);
  const MeasuredGhost& ghost = fit->flare.ghosts[1];
  REQUIRE(!ghost.clip_radius.coefficients.empty());
  // The circle's edge within the disc, where the light is far from the axis.
  for (const double s : {0.3, 0.4}) {
    const double edge = ghost.clip_centre(s) - ghost.clip_radius(s);
    CHECK(edge == test::approx(-0.25 * s - 0.16).epsilon(0.02));
    CHECK(ghost.centre(s) + ghost.half_width(s) + ghost.skew(s) ==
          test::approx(-0.6 * s + 0.13).epsilon(0.006).scale(1.0));
  }
  CHECK(fit->held_out_nrmse < 0.05);
}
