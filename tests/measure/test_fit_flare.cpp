// SPDX-License-Identifier: Apache-2.0
// Flares learned from simulated captures, which the exact renderer makes and not the model that is fitted.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include <doctest/doctest.h>

#include "base/units.h"
#include "contrejour/expert/fit_comparison.h"
#include "contrejour/expert/fit_flare.h"
#include "contrejour/expert/sweep.h"
#include "measure/fit/flare_fit_state.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

struct Capture {
  SweepSettings settings;
  std::vector<CapturedImage> pictures;
  std::vector<std::optional<DirectFlux>> direct;
  SweepGeometry geometry;

  [[nodiscard]] FlareSweep sweep() const {
    FlareSweep all;
    for (const double angle : settings.angles_deg) all.angles_rad.push_back(rad_from_deg(angle));
    const double light = settings.light_rate / 4.0;  // pixels of half the raw size
    all.light = {light, light, light};
    all.direct = direct;
    all.picture = [this](std::size_t k) -> Result<CapturedImage> { return pictures[k]; };
    return all;
  }
};

const Capture& tessar() {
  static const Capture capture = [] {
    const LensState lens = *configure_lens(*find_lens("tessar"), {});
    Capture all;
    all.settings.angles_deg = even_angles_deg(0.95 * largest_angle_deg(lens), 13);
    all.settings.width = 320;
    all.settings.height = 214;
    all.settings.light_rate = *automatic_light_rate(lens, all.settings);
    std::vector<DirectImage> lights;
    for (std::size_t k = 0; k < all.settings.angles_deg.size(); ++k) {
      const SweepStation station = *simulate_station(lens, all.settings, k);
      all.pictures.push_back(*merge_exposures(station.exposures, station.background));
      const auto at = direct_flux(station.direct);
      all.direct.push_back(at ? std::optional(*at) : std::nullopt);
      if (at) lights.push_back({rad_from_deg(station.angle_deg), at->position_px});
    }
    all.geometry = *fit_geometry(lights);
    return all;
  }();
  return capture;
}

FlareFitOptions quick() {
  FlareFitOptions options;
  options.max_ghosts = 1;
  options.max_small_ghosts = 0;
  return options;
}

// Stations without any light.
FlareSweep dark_sweep() {
  FlareSweep sweep;
  for (int k = -3; k <= 3; ++k) sweep.angles_rad.push_back(0.05 * k);
  sweep.picture = [](std::size_t) -> Result<CapturedImage> {
    CapturedImage image{Image(96, 64), Image(96, 64), Image(96, 64, 1), {}};
    for (float& v : image.variance.pixels) v = 1.0F;
    for (float& v : image.valid.pixels) v = 1.0F;
    return image;
  };
  return sweep;
}

const SweepGeometry kPlain{{48.0, 32.0}, 100.0, 0.0, 0.0, 0.0, 0.0, {}};

}  // namespace

TEST_CASE("fit flare: the Tessar's bright ghost is found and fitted, and the optical centre with it [slow]") {
  const Capture& capture = tessar();
  SweepGeometry geometry = capture.geometry;
  geometry.centre_px.x += 0.8;  // the light's images alone could be so far off
  const auto fit = fit_flare(capture.sweep(), geometry, quick());
  REQUIRE_MESSAGE(fit.has_value(), fit.error().to_string());
  REQUIRE(fit->found.size() == 1);
  const MeasuredGhost& ghost = fit->flare.ghosts[1];
  // Read off the exact renderer's pictures of 320 pixels, to 1 and 2 per cent.
  CHECK(ghost.centre.derivative(0.0) == test::approx(-1.09).epsilon(0.03));
  // Which disc is found first decides how ghosts share light: 0.0316 to 0.0382 were seen, for captures that differed by
  // less than the renderer's error.
  CHECK(ghost.half_height(0.0) == test::approx(0.0358).epsilon(0.15));
  const double centre = 0.25 * 320 + 0.5 * capture.settings.centre_offset_px.x;
  CHECK(std::abs(fit->centre_px.x - centre) < 0.1);
  CHECK(std::abs(fit->centre_px.y - (0.25 * 214 + 0.5 * capture.settings.centre_offset_px.y)) < 0.1);
  // Three of thirteen stations are held out, and are described about as well as the others; up to 1.32 times was seen,
  // as above.
  REQUIRE(fit->stations.size() == 13);
  CHECK(std::ranges::count(fit->stations, true, &FittedStation::held_out) == 3);
  CHECK(fit->held_out_nrmse < 1.4 * fit->nrmse);
}

TEST_CASE("fit comparison: from one start, both costs fall, and every picture is counted [slow]") {
  const Capture& capture = tessar();
  FoundGhost disc;
  disc.speed = -1.15;
  disc.radius = 0.04;
  disc.last = 0.18;
  ComparisonSettings settings;
  settings.max_stations = 5;
  settings.max_width = 80;
  settings.walch_iterations = 12;
  settings.our_iterations = 8;
  const auto both =
      compare_with_walch(capture.sweep(), capture.geometry, std::span(&disc, 1), capture.geometry.centre_px, settings);
  REQUIRE_MESSAGE(both.has_value(), both.error().to_string());
  CHECK(both->ours.front().cost == both->walch.front().cost);
  CHECK(both->ours.front().cost == test::approx(both->ours.front().mse + both->ours.front().edges));
  CHECK(both->ours.back().cost < 0.8 * both->ours.front().cost);
  CHECK(both->walch.back().cost < both->walch.front().cost);
  const double stations = 5.0;
  CHECK(both->walch.back().image_evaluations == stations * (1.0 + 12.0 * 24.0));
  CHECK(both->walch.size() == 1 + 5 * 12);
  CHECK(std::fmod(both->ours.back().image_evaluations, stations) == 0.0);
  CHECK(!compare_with_walch(capture.sweep(), capture.geometry, {}, {}, settings));
}

TEST_CASE("fit flare: the same bits for any number of threads [slow]") {
  const Capture& capture = tessar();
  FlareFitOptions options = quick();
  options.max_width = 80;
  const auto one = fit_flare(capture.sweep(), capture.geometry, options, {.threads = 1});
  const auto three = fit_flare(capture.sweep(), capture.geometry, options, {.threads = 3});
  REQUIRE(one.has_value());
  REQUIRE(three.has_value());
  CHECK(write_flare(one->flare) == write_flare(three->flare));
}

TEST_CASE("fit flare: angles with the sign swapped give the same flare [slow]") {
  const Capture& capture = tessar();
  FlareSweep swapped = capture.sweep();
  for (double& angle : swapped.angles_rad) angle = -angle;
  SweepGeometry geometry = capture.geometry;
  geometry.focal_length_px = -geometry.focal_length_px;
  geometry.zero_rad = -geometry.zero_rad;
  FlareFitOptions options = quick();
  options.max_width = 80;
  const auto as_is = fit_flare(capture.sweep(), capture.geometry, options);
  const auto fit = fit_flare(swapped, geometry, options);
  REQUIRE(as_is.has_value());
  REQUIRE(fit.has_value());
  REQUIRE(fit->flare.ghosts.size() == as_is->flare.ghosts.size());
  CHECK(as_is->warnings.empty());
  REQUIRE(fit->warnings.size() == 1);
  CHECK(fit->warnings[0].find("sign is swapped") != std::string::npos);
  CHECK(fit->flare.ghosts.back().centre(0.1) == test::approx(as_is->flare.ghosts.back().centre(0.1)).epsilon(1e-6));
}

TEST_CASE("fit flare: a core that every exposure saturates is left out, said if it is large, and survived [slow]") {
  const Capture& capture = tessar();
  Capture saturated = capture;
  std::size_t marked = 0;
  for (CapturedImage& picture : saturated.pictures) {
    // All but the dimmer half of the ghost: it stands out of everything but the light's own image.
    std::vector<float> values(picture.rate.pixels.begin(), picture.rate.pixels.end());
    std::ranges::sort(values);
    const float level = 0.5F * values[values.size() * 97 / 100];
    for (std::size_t k = 0; k < picture.rate.pixels.size(); ++k) {
      if (!(picture.rate.pixels[k] > level)) continue;
      picture.valid.pixels[k] = 0.0F;
      picture.rate.pixels[k] = level;  // the sensor's end
      ++marked;
    }
  }
  FlareFitOptions options = quick();
  options.max_width = 80;
  const auto fit = fit_flare(saturated.sweep(), capture.geometry, options);
  REQUIRE_MESSAGE(fit.has_value(), fit.error().to_string());
  CHECK(marked > 1000);
  for (const MeasuredGhost& ghost : fit->flare.ghosts)
    for (const AngleCurve& level : ghost.inside) CHECK(std::isfinite(level(0.1)));
  CHECK(check_flare(fit->flare).has_value());
  CHECK(std::ranges::any_of(fit->warnings,
                            [](const std::string& w) { return w.find("saturated") != std::string::npos; }));
}

TEST_CASE("fit flare: a ghost with values beyond all limits is left out, and said") {
  FlareFit fit;
  fit.flare().s_max = 0.4;
  MeasuredGhost ghost;
  ghost.centre.coefficients = {-1.0};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {0.1};
  ghost.width_in.coefficients = ghost.width_out.coefficients = {0.01};
  for (std::size_t c = 0; c < 3; ++c) ghost.border[c].coefficients = ghost.inside[c].coefficients = {1.0};
  ghost.last = 0.4;
  fit.flare().ghosts = {ghost, ghost, ghost};
  fit.flare().ghosts[1].inside[2].coefficients = {1e300};
  drop_unbounded(fit);
  CHECK(fit.flare().ghosts.size() == 2);
  CHECK(check_flare(fit.flare()).has_value());
  REQUIRE(fit.result.warnings.size() == 1);
  CHECK(fit.result.warnings[0].find("left out") != std::string::npos);
}

TEST_CASE("fit flare: pictures without a ghost give none, and a warning") {
  const auto fit = fit_flare(dark_sweep(), kPlain);
  REQUIRE(fit.has_value());
  CHECK(fit->flare.ghosts.empty());
  REQUIRE(fit->warnings.size() == 1);
  CHECK(fit->warnings[0].find("no ghost") != std::string::npos);
}

TEST_CASE("fit flare: wrong input is refused, a picture's error is handed on, cancelling stops") {
  FlareSweep sweep = dark_sweep();
  sweep.angles_rad.resize(3);
  CHECK(!fit_flare(sweep, kPlain));
  CHECK(!fit_flare(dark_sweep(), {}));
  sweep = dark_sweep();
  const auto whole = sweep.picture;
  sweep.picture = [&](std::size_t k) -> Result<CapturedImage> {
    if (k == 4) return failure(ErrorCode::Io, "station 4 cannot be read");
    return whole(k);
  };
  CHECK(fit_flare(sweep, kPlain).error().message == "station 4 cannot be read");
  sweep.picture = [&](std::size_t k) -> Result<CapturedImage> {
    Result<CapturedImage> image = whole(k);
    if (k == 4) image->rate = image->variance = Image(48, 32);
    if (k == 4) image->valid = Image(48, 32, 1);
    return image;
  };
  CHECK(!fit_flare(sweep, kPlain));
  const std::atomic<bool> cancel{true};
  const auto cancelled = fit_flare(dark_sweep(), kPlain, {}, {.cancel = &cancel});
  REQUIRE(!cancelled);
  CHECK(cancelled.error().code == ErrorCode::Cancelled);
}
