// SPDX-License-Identifier: Apache-2.0
// The measured flare: its file, its curves, and its pictures against a plain evaluation of every pixel.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <doctest/doctest.h>

#include "contrejour/expert/measured_flare.h"
#include "measure/random_ghosts.h"
#include "support/approx.h"

using namespace contrejour;
using contrejour::test::random_cut_ghost;
using contrejour::test::random_ghost;
using contrejour::test::random_ghost_with_profile;

namespace {

MeasuredFlare random_flare(int ghosts, unsigned seed = 1) {
  std::mt19937 random(seed);
  MeasuredFlare flare{"test", "random", 0.6, CaptureExposure{1.4, 100.0, 1.0}, {}};
  for (int k = 0; k < ghosts; ++k) flare.ghosts.push_back(random_ghost(random));
  return flare;
}

// Every second ghost with a profile.
MeasuredFlare random_flare_with_profiles(int ghosts) {
  std::mt19937 random(3);
  MeasuredFlare flare = random_flare(0);
  for (int k = 0; k < ghosts; ++k)
    flare.ghosts.push_back(k % 2 == 0 ? random_ghost_with_profile(random) : random_ghost(random));
  return flare;
}

constexpr TangentFrame kFrame{240, 160, 220.0, {118.3, 82.1}};

// The mean of a ghost's shade over the pixel about a place: over 4 x 4 squares if the ghost is small.
ShadeWeights plain_weights(const GhostAtAngle& at, Vec2 along, Vec2 place, double pixel) {
  const bool is_small = std::min(0.5 * (at.outline.left + at.outline.right), at.outline.half_height) < 1.5 * pixel;
  const int across = is_small ? 4 : 1;
  ShadeWeights mean{};
  for (int k = 0; k < across * across; ++k) {
    const Vec2 square{((k % across + 0.5) / across - 0.5) * pixel, ((k / across + 0.5) / across - 0.5) * pixel};
    const Vec2 point = place + square;
    const double distance = nearest_point(at.outline, {dot(along, point), cross(along, point)}).distance;
    const ShadeWeights weights = shade_weights(at.shade, distance, pixel / across);
    mean.border += weights.border / (across * across);
    mean.inside += weights.inside / (across * across);
  }
  return mean;
}

// The same picture, one pixel after the other in double precision.
Image plain_picture(const MeasuredFlare& flare, const FlareLight& light, const TangentFrame& frame) {
  Image image(frame.width, frame.height);
  const double s = length(light.position), pixel = 1.0 / frame.focal_length_px;
  const Vec2 along = light.position * (1.0 / s);
  for (const MeasuredGhost& ghost : flare.ghosts) {
    const auto at = ghost_at(ghost, s, flare.s_max);
    if (!at) continue;
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        const Vec2 point{(x + 0.5 - frame.centre_px.x) * pixel, (frame.centre_px.y - y - 0.5) * pixel};
        const Vec2 turned{dot(along, point), cross(along, point)};
        const ShadeWeights weights = plain_weights(*at, along, point, pixel);
        const Rgb inside = at->inside_at(turned);
        for (std::size_t c = 0; c < 3; ++c) {
          const double level = at->border[c] * weights.border + inside[c] * weights.inside;
          image.at(x, y, static_cast<int>(c)) += static_cast<float>(light.value[c] * level * pixel * pixel);
        }
      }
    }
  }
  return image;
}

double largest(const Image& image) { return *std::max_element(image.pixels.begin(), image.pixels.end()); }

double largest_difference(const Image& a, const Image& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    largest = std::max(largest, std::abs(static_cast<double>(a.pixels[k]) - static_cast<double>(b.pixels[k])));
  }
  return largest;
}

}  // namespace

TEST_CASE("measured flare: curves are even, odd or neither") {
  CHECK(AngleCurve{Parity::Even, {1.0, 2.0}}(-0.5) == test::approx(1.5));
  CHECK(AngleCurve{Parity::Odd, {1.0, 2.0}}(-0.5) == test::approx(-0.75));
  CHECK(AngleCurve{Parity::None, {1.0, 2.0, 4.0}}(-0.5) == test::approx(1.0));
  CHECK(AngleCurve{}(0.3) == 0.0);
}

TEST_CASE("measured flare: a file reads back bit for bit") {
  MeasuredFlare flare = random_flare(7);
  flare.half_field = Vec2{0.75, 0.5};
  flare.ghosts[2].width_in.parity = Parity::None;
  flare.ghosts[2].width_in.coefficients = {0.1, 1e-17, -3.0};
  const std::string text = write_flare(flare);
  const auto again = read_flare(text, "a.flare.toml");
  REQUIRE_MESSAGE(again.has_value(), again.error().to_string());
  CHECK(write_flare(*again) == text);
  CHECK(again->ghosts.size() == 7);
  CHECK(again->exposure->f_number == 1.4);
  CHECK(again->half_field->x == 0.75);
}

TEST_CASE("measured flare: profiles are kept, drawn and checked") {
  const MeasuredFlare flare = random_flare_with_profiles(5);
  const std::string text = write_flare(flare);
  const auto again = read_flare(text, "a.flare.toml");
  REQUIRE_MESSAGE(again.has_value(), again.error().to_string());
  CHECK(write_flare(*again) == text);
  for (const Vec2 position : {Vec2{0.3, 0.0}, Vec2{-0.2, 0.25}}) {
    const FlareLight light{position, {1e5, 2e5, 5e4}};
    const auto image = render_measured(flare, std::span(&light, 1), kFrame);
    REQUIRE(image.has_value());
    const Image plain = plain_picture(flare, light, kFrame);
    CHECK(largest_difference(*image, plain) < 2e-3 * largest(plain));
  }
  MeasuredFlare broken = flare;
  broken.ghosts[0].profile[1].pop_back();
  CHECK(!check_flare(broken));
  const auto refused = read_flare("name = \"n\"\ns_max = 0.5\n[[ghosts]]\nlast = 0.4\nprofile_red = [[1]]\n", "a.toml");
  REQUIRE(!refused);
  CHECK(refused.error().to_string().find("a.toml:5:") == 0);
}

TEST_CASE("measured flare: a ghost that has shrunk to nothing is not drawn, a slim one has no light beside it") {
  MeasuredGhost ghost;
  ghost.half_width.coefficients = {0.1};
  ghost.half_height.coefficients = {0.1, -0.5};  // 0 at s = 0.447
  for (AngleCurve& level : ghost.inside) level.coefficients = {1.0};
  ghost.last = 0.5;
  CHECK(!ghost_at(ghost, 0.48, 0.5));
  ghost.half_height.coefficients = {1e-6};
  const MeasuredFlare flare{"slim", "", 0.5, std::nullopt, {ghost}};
  const FlareLight light{{0.3, 0.01}, {1e6, 1e6, 1e6}};
  const auto image = render_measured(flare, std::span(&light, 1), kFrame);
  REQUIRE(image.has_value());
  // Its pixels are half covered at most, and lie in a row of the ghost's width, 44 pixels.
  CHECK(largest(*image) < 0.6 * 1e6 / (kFrame.focal_length_px * kFrame.focal_length_px));
  CHECK(std::ranges::count_if(image->pixels, [](float v) { return v > 0.0F; }) < 3 * 3 * 48);
}

TEST_CASE("measured flare: errors name file and line") {
  const auto error = [](const char* text) {
    const auto flare = read_flare(text, "a.toml");
    return flare ? std::string("accepted") : flare.error().to_string();
  };
  const std::string head = "name = \"n\"\ns_max = 0.5\n";
  CHECK(error("name = \"n\"\n").find("s_max") != std::string::npos);
  CHECK(error((head + "[[ghosts]]\nlast = 0.7\n").c_str()).find("a.toml: ghost \"1\"") == 0);
  CHECK(error((head + "[[ghosts]]\nlast = 0.4\ncentre = 3\n").c_str()).find("a.toml:5:") == 0);
  CHECK(error((head + "[[ghosts]]\nlast = 0.4\ncenter = [3]\n").c_str()).find("a.toml:5:") == 0);
  CHECK(error((head + "[[ghosts]]\nlast = 0.4\ncentre = [nan]\n").c_str()).find("a.toml:5:") == 0);
  CHECK(error((head + "ghosts = [1]\n").c_str()).find("a.toml:3:") == 0);
  CHECK(error((head + "half_field = [1]\n").c_str()).find("a.toml:3:") == 0);
  CHECK(error((head + "half_field = [1, 0]\n").c_str()).find("half_field") != std::string::npos);
  CHECK(error((head + "[[ghosts]]\nlast = 0.4\ncentre = [1e10]\n").c_str()).find("exceeds") != std::string::npos);
}

TEST_CASE("measured flare: circles that cut ghosts are kept and drawn") {
  std::mt19937 random(11);
  MeasuredFlare flare = random_flare(1);
  for (int k = 0; k < 4; ++k) flare.ghosts.push_back(random_cut_ghost(random));
  const std::string text = write_flare(flare);
  const auto again = read_flare(text, "a.flare.toml");
  REQUIRE_MESSAGE(again.has_value(), again.error().to_string());
  CHECK(write_flare(*again) == text);
  MeasuredFlare whole = flare;
  for (MeasuredGhost& ghost : whole.ghosts) ghost.clip_radius.coefficients.clear();
  for (const Vec2 position : {Vec2{0.3, 0.0}, Vec2{-0.2, 0.25}}) {
    const FlareLight light{position, {1e5, 2e5, 5e4}};
    const auto image = render_measured(flare, std::span(&light, 1), kFrame);
    REQUIRE(image.has_value());
    const Image plain = plain_picture(flare, light, kFrame);
    CHECK(largest_difference(*image, plain) < 2e-3 * largest(plain));
    CHECK(largest_difference(*image, plain_picture(whole, light, kFrame)) > 0.1 * largest(plain));
  }
}

TEST_CASE("measured flare: pictures agree with a plain evaluation of every pixel") {
  const MeasuredFlare flare = random_flare(6);
  for (const Vec2 position : {Vec2{0.3, 0.0}, Vec2{-0.2, 0.25}, Vec2{0.05, -0.4}}) {
    const FlareLight light{position, {1e5, 2e5, 5e4}};
    const auto image = render_measured(flare, std::span(&light, 1), kFrame);
    REQUIRE(image.has_value());
    const Image plain = plain_picture(flare, light, kFrame);
    CHECK(largest(plain) > 0.0);
    CHECK(largest_difference(*image, plain) < 2e-3 * largest(plain));
  }
}

TEST_CASE("measured flare: the same bits for any number of threads; lights add") {
  const MeasuredFlare flare = random_flare(12);
  const std::array<FlareLight, 2> lights{FlareLight{{0.3, 0.1}, {1e4, 1e4, 1e4}},
                                         FlareLight{{-0.1, 0.2}, {5e4, 0, 1e3}}};
  const auto one = render_measured(flare, lights, kFrame, {.threads = 1});
  const auto four = render_measured(flare, lights, kFrame, {.threads = 4});
  REQUIRE(one.has_value());
  CHECK(one->pixels == four->pixels);
  const auto first = render_measured(flare, std::span(&lights[0], 1), kFrame);
  const auto second = render_measured(flare, std::span(&lights[1], 1), kFrame);
  Image sum = *first;
  for (std::size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += second->pixels[k];
  CHECK(largest_difference(*one, sum) < 1e-5 * largest(sum));
}

TEST_CASE("measured flare: a disc of level 1 sums to its area, at any resolution") {
  MeasuredGhost disc;
  disc.half_width.coefficients = disc.half_height.coefficients = {0.1};
  for (AngleCurve& level : disc.inside) level.coefficients = {1.0};
  disc.last = 0.5;
  const MeasuredFlare flare{"disc", "", 0.5, std::nullopt, {disc}};
  const FlareLight light{{0.2, 0.0}, {1.0, 1.0, 1.0}};
  for (const double focal_length_px : {60.0, 200.0, 500.0}) {
    const int side = static_cast<int>(0.3 * focal_length_px);
    const TangentFrame frame{side, side, focal_length_px, {0.5 * side, 0.5 * side}};
    const auto image = render_measured(flare, std::span(&light, 1), frame);
    REQUIRE(image.has_value());
    const double sum = std::accumulate(image->pixels.begin(), image->pixels.end(), 0.0) / 3.0;
    CHECK(sum == test::approx(std::numbers::pi * 0.01).epsilon(3e-3));
  }
}

TEST_CASE("measured flare: a disc smaller than a pixel sums to its area wherever it lies in the pixel") {
  const double radius_px = 0.4, pixel = 1.0 / kFrame.focal_length_px;
  MeasuredGhost ghost;
  ghost.centre.coefficients = {1.0};
  ghost.half_width.coefficients = ghost.half_height.coefficients = {radius_px * pixel};
  ghost.width_in.coefficients = ghost.width_out.coefficients = {0.02 * pixel};
  for (AngleCurve& level : ghost.inside) level.coefficients = {1.0};
  for (AngleCurve& level : ghost.border) level.coefficients = {1.0};
  ghost.last = 0.5;
  const MeasuredFlare flare{"point", "", 0.5, std::nullopt, {ghost}};
  const double area = std::numbers::pi * std::pow((radius_px + 0.02) * pixel, 2);
  for (const double x : {0.0, 0.17, 0.31, 0.5, 0.83}) {
    for (const double y : {0.0, 0.25, 0.61}) {
      const FlareLight light{{(30.0 + x) * pixel, (20.0 + y) * pixel}, {1.0, 1.0, 1.0}};
      const auto image = render_measured(flare, std::span(&light, 1), kFrame);
      REQUIRE(image.has_value());
      const double sum = std::accumulate(image->pixels.begin(), image->pixels.end(), 0.0) / 3.0;
      CHECK(sum == test::approx(area).epsilon(0.05));
    }
  }
}

TEST_CASE("measured flare: a ghost fades at the ends of its range, the flare beyond the measured angles") {
  MeasuredGhost ghost;
  ghost.half_width.coefficients = ghost.half_height.coefficients = {0.1};
  for (AngleCurve& level : ghost.inside) level.coefficients = {1.0};
  ghost.first = 0.1;
  ghost.last = 0.4;
  ghost.transition = 0.05;
  CHECK(!ghost_at(ghost, 0.05, 0.5));
  CHECK(ghost_at(ghost, 0.125, 0.5)->inside[0] == test::approx(0.5));
  CHECK(ghost_at(ghost, 0.2, 0.5)->inside[0] == test::approx(1.0));
  CHECK(ghost_at(ghost, 0.375, 0.5)->inside[0] == test::approx(0.5));
  ghost.last = 0.5;  // the end of what was measured
  CHECK(ghost_at(ghost, 0.5, 0.5)->inside[0] == test::approx(1.0));
  const MeasuredFlare flare{"one", "", 0.5, std::nullopt, {ghost}};
  const auto sum_at = [&](double s) {
    const FlareLight light{{s, 0.0}, {1.0, 1.0, 1.0}};
    const auto image = render_measured(flare, std::span(&light, 1), kFrame);
    return std::accumulate(image->pixels.begin(), image->pixels.end(), 0.0);
  };
  CHECK(sum_at(0.55) == test::approx(0.5 * sum_at(0.5)).epsilon(1e-5));
  CHECK(sum_at(0.61) == 0.0);
}

TEST_CASE("measured flare: brightness by walch2018's equation 2") {
  const CaptureExposure capture{1.4, 100.0, 1.0};
  CHECK(brightness_scale(capture, capture, 1.0) == test::approx(1.0));
  CHECK(brightness_scale(capture, {1.4, 200.0, 1.0}, 1.0) == test::approx(2.0));
  CHECK(brightness_scale(capture, {1.4, 100.0, 0.5}, 1.0) == test::approx(0.5));
  CHECK(brightness_scale(capture, {2.8, 100.0, 1.0}, 1.0) == test::approx(0.25));
  CHECK(brightness_scale(capture, capture, 3.0) == test::approx(3.0));
}

TEST_CASE("measured flare: hostile requests are refused") {
  const MeasuredFlare flare = random_flare(1);
  const FlareLight light{{0.1, 0.0}, {1.0, 1.0, 1.0}};
  CHECK(!render_measured(flare, std::span(&light, 1), {0, 10, 100.0, {}}));
  CHECK(!render_measured(flare, std::span(&light, 1), {100000, 100000, 100.0, {}}));
  CHECK(!render_measured(flare, std::span(&light, 1), {10, 10, -1.0, {}}));
  const FlareLight broken{{std::nan(""), 0.0}, {1.0, 1.0, 1.0}};
  CHECK(!render_measured(flare, std::span(&broken, 1), kFrame));
  CHECK(render_measured(flare, {}, kFrame)->pixels == Image(240, 160).pixels);
}
