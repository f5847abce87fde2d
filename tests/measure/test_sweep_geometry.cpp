// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "base/units.h"
#include "contrejour/expert/sweep_geometry.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

const SweepGeometry kTruth{{612.4, 401.7}, 1700.0, -0.03, 0.004, 0.006, 0.0, {}};

// Images of a sweep, their centroids off by `noise` pixels and their angles by `jitter`.
std::vector<DirectImage> swept(double from_deg, double to_deg, int stations, double noise = 0.0,
                               double jitter_deg = 0.0) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<DirectImage> images;
  for (int k = 0; k < stations; ++k) {
    const double angle = rad_from_deg(from_deg + (to_deg - from_deg) * k / (stations - 1));
    const Vec2 at = kTruth.position_of(angle + rad_from_deg(jitter_deg) * normal(random));
    images.push_back({angle, {at.x + noise * normal(random), at.y + noise * normal(random)}});
  }
  return images;
}

}  // namespace

TEST_CASE("sweep geometry: exact positions give the exact geometry") {
  const auto found = fit_geometry(swept(-20.0, 20.0, 21));
  REQUIRE(found.has_value());
  CHECK(found->centre_px.x == test::approx(kTruth.centre_px.x).epsilon(1e-6));
  CHECK(found->centre_px.y == test::approx(kTruth.centre_px.y).epsilon(1e-6));
  CHECK(found->focal_length_px == test::approx(1700.0).epsilon(1e-6));
  CHECK(found->distortion == test::approx(-0.03).epsilon(1e-4));
  CHECK(found->zero_rad == test::approx(0.004).epsilon(1e-4));
  CHECK(found->roll_rad == test::approx(0.006).epsilon(1e-4));
  CHECK(found->rms_px < 1e-6);
}

TEST_CASE("sweep geometry: the stated error of the centre covers what is found") {
  for (const auto& [to_deg, stations] : {std::pair{30.0, 61}, std::pair{18.0, 301}}) {
    const auto found = fit_geometry(swept(-to_deg, to_deg, stations, 0.05));
    REQUIRE(found.has_value());
    CHECK(std::abs(found->centre_px.x - kTruth.centre_px.x) < 4.0 * found->centre_error_px.x);
    CHECK(std::abs(found->centre_px.y - kTruth.centre_px.y) < 4.0 * found->centre_error_px.y + 0.05);
    CHECK(std::abs(found->centre_px.x - kTruth.centre_px.x) < 0.5);
  }
  CHECK(fit_geometry(swept(0.0, 8.0, 21, 0.05))->centre_error_px.x > 3.0);  // one side, few degrees
}

TEST_CASE("sweep geometry: an expected centre keeps it near where few degrees leave it open, and does nothing else") {
  const std::vector<DirectImage> few = swept(-7.5, 7.5, 31, 0.02, 0.02);  // a zoom lens at its long end
  const auto alone = fit_geometry(few);
  const double off = 10.0, expected_error = 12.0;
  const ExpectedCentre expected{{kTruth.centre_px.x + off, kTruth.centre_px.y}, expected_error};
  const auto both = fit_geometry(few, expected);
  REQUIRE(alone.has_value());
  REQUIRE(both.has_value());
  CHECK(alone->centre_error_px.x > 2.0 * expected_error);
  CHECK(std::abs(alone->centre_px.x - kTruth.centre_px.x) > 2.0 * off);
  CHECK(std::abs(both->centre_px.x - kTruth.centre_px.x) < 1.5 * off);
  CHECK(both->centre_error_px.x < 1.01 * expected_error);
  CHECK(both->focal_length_px == test::approx(1700.0).epsilon(0.005));
  const auto wide = fit_geometry(swept(-30.0, 30.0, 61, 0.05), expected);
  REQUIRE(wide.has_value());
  CHECK(std::abs(wide->centre_px.x - kTruth.centre_px.x) < 0.5);
  const auto exact = fit_geometry(swept(-20.0, 20.0, 21), expected);
  REQUIRE(exact.has_value());
  CHECK(exact->centre_px.x == test::approx(kTruth.centre_px.x).epsilon(1e-6));
  CHECK(!fit_geometry(few, ExpectedCentre{{600.0, 400.0}, 0.0}));
  CHECK(expected_centre(1200, 800).position_px.y == 400.0);
  CHECK(expected_centre(1200, 800).error_px == test::approx(12.0));
}

TEST_CASE("sweep geometry: a reflection taken for the light does little harm; swapped angles show") {
  std::vector<DirectImage> images = swept(-25.0, 25.0, 41, 0.02);
  images[7].position_px = {100.0, 700.0};
  const auto found = fit_geometry(images);
  REQUIRE(found.has_value());
  CHECK(length(found->centre_px - kTruth.centre_px) < 0.7);
  images = swept(-25.0, 25.0, 41, 0.02);
  for (DirectImage& image : images) image.angle_rad = -image.angle_rad;
  CHECK(fit_geometry(images)->focal_length_px < 0.0);
}

TEST_CASE("sweep geometry: too few or resting images are refused") {
  CHECK(!fit_geometry(swept(-10.0, 10.0, 4)));
  CHECK(!fit_geometry(swept(-0.01, 0.01, 9)));
  CHECK(!fit_geometry({}));
}

TEST_CASE("sweep geometry: the light's image in a short exposure") {
  RawFrame frame{64, 48, BayerPattern::Rggb, 512.0, 16383.0, 0.001, std::vector<std::uint16_t>(64 * 48, 512)};
  CHECK(!direct_image_position(frame));
  for (int y = 20; y < 26; ++y) {
    for (int x = 30; x < 40; ++x) frame.dn[static_cast<std::size_t>(y * 64 + x)] = 8000;
  }
  const auto at = direct_image_position(frame);
  REQUIRE(at.has_value());
  CHECK(at->x == test::approx(17.5));
  CHECK(at->y == test::approx(11.5));
  for (std::uint16_t& dn : frame.dn) dn = dn > 600 ? 16383 : dn;
  CHECK(!direct_image_position(frame));
}
