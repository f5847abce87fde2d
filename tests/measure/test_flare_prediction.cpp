// SPDX-License-Identifier: Apache-2.0
// Figures of flares against closed forms, maps of lights against single renderings, lights of panoramas against the
// pixels of their views.
#include <cmath>
#include <numbers>
#include <numeric>

#include <doctest/doctest.h>

#include "contrejour/expert/flare_prediction.h"
#include "contrejour/expert/panorama.h"
#include "contrejour/expert/trace.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr double kRadian = std::numbers::pi / 180.0;

Image image_of(int width, int height, const std::vector<double>& levels) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) image.pixels[k] = static_cast<float>(levels[k / 3]);
  return image;
}

// A disc of level 1 and radius 0.1 whose centre is `speed` times the light's position.
MeasuredFlare disc_flare(double speed) {
  MeasuredGhost disc;
  disc.centre.coefficients = {speed};
  disc.half_width.coefficients = disc.half_height.coefficients = {0.1};
  for (AngleCurve& level : disc.inside) level.coefficients = {1.0};
  disc.last = 0.5;
  return {"disc", "", 0.5, CaptureExposure{1.4, 100.0, 1.0}, {disc}, Vec2{0.6, 0.4}};
}

double total(const Image& image) { return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / 3.0; }

Vec2 centroid(const Image& image) {
  Vec2 sum;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) sum = sum + Vec2{x + 0.5, y + 0.5} * static_cast<double>(image.at(x, y, 1));
  }
  return sum * (1.0 / total(image));
}

}  // namespace

TEST_CASE("prediction: figures of the flare alone") {
  const Image flare = image_of(2, 2, {0.0, 1.0, 4.0, 16.0});
  const auto figures = figures_of(flare, {.white = 10.0, .covered_level = 0.2});
  REQUIRE(figures.has_value());
  CHECK(figures->minimum == test::approx(0.0));
  CHECK(figures->maximum == test::approx(16.0));
  CHECK(figures->sum == test::approx(21.0));
  CHECK(figures->mean == test::approx(5.25));
  CHECK(figures->covered == 0.5);
  const double offset = 1e-5;
  CHECK(figures->log_average == test::approx(std::pow(offset * 64.0, 0.25)).epsilon(1e-3));
  CHECK(!figures_of(Image(0, 0)));
  CHECK(!figures_of(Image(2, 2, 1)));
  CHECK(!figures_of(flare, {.white = 0.0}));
}

TEST_CASE("prediction: samples that are not finite are left out") {
  Image flare = image_of(2, 2, {1.0, 1.0, 1.0, 1.0});
  flare.at(0, 0, 1) = std::nanf("");
  CHECK(figures_of(flare)->sum == test::approx(3.0));
}

TEST_CASE("prediction: even flare of level f leaves a contrast of 1 / (1 + 2 f) between black and white") {
  std::vector<double> halves(200, 0.0);
  std::fill(halves.begin(), halves.begin() + 100, 1.0);
  const Image scene = image_of(20, 10, halves);
  for (const double f : {0.0, 0.01, 0.3}) {
    const auto figures = figures_on(scene, image_of(20, 10, std::vector<double>(200, f)));
    REQUIRE(figures.has_value());
    CHECK(figures->contrast_without == test::approx(1.0));
    CHECK(figures->contrast_with == test::approx(1.0 / (1.0 + 2.0 * f)));
    CHECK(figures->contrast_kept == test::approx(1.0 / (1.0 + 2.0 * f)));
    const double scene_log = std::sqrt(1e-6 * (1.0 + 1e-6));
    CHECK(figures->log_average_ratio == test::approx(scene_log / (f + 1e-6)).epsilon(1e-4));
    CHECK(figures->brightening == test::approx(std::sqrt((f + 1e-6) * (1.0 + f)) / scene_log).epsilon(1e-4));
  }
  CHECK(!figures_on(scene, Image(10, 20)));
}

TEST_CASE("prediction: transmission is over the direct image's level, attenuation its inverse") {
  const Frame frame{100, 50, 0, 0, 100, 50, 0.01};
  const double radius_rad = std::atan(0.05 / 20.0);  // 0.05 mm at 20 mm: 5 pixels
  CHECK(*direct_level(500.0, radius_rad, frame, 20.0) == test::approx(500.0 / (25.0 * std::numbers::pi)));
  CHECK(!direct_level(500.0, 0.0, frame, 20.0));
  const Image flare = image_of(20, 10, std::vector<double>(200, 0.02));
  const auto glare = glare_of(flare, 40.0, ColourSpace::Rec709);
  REQUIRE(glare.has_value());
  CHECK(glare->mean_transmission == test::approx(5e-4));
  CHECK(glare->peak_transmission == test::approx(5e-4));
  CHECK(glare->mean_attenuation == test::approx(2000.0));
  CHECK(std::isinf(glare_of(Image(4, 4), 1.0, ColourSpace::Rec709)->least_attenuation));
  CHECK(!glare_of(flare, 0.0, ColourSpace::Rec709));
}

TEST_CASE("prediction: a rating says where a value lies among others") {
  const std::vector<double> others{1.0, 2.0, 2.0, 5.0};
  CHECK(rating_of(2.0, others)->in_range == test::approx(0.25));
  CHECK(rating_of(2.0, others)->rank == test::approx(0.5));
  CHECK(rating_of(5.0, others)->in_range == test::approx(1.0));
  CHECK(rating_of(6.0, others)->rank == test::approx(1.0));
  CHECK(rating_of(1.0, std::vector<double>{1.0, 1.0})->in_range == 0.0);
  CHECK(!rating_of(1.0, {}));
}

TEST_CASE("prediction: a measured flare is drawn where a lens would draw it") {
  CHECK(is_measured_flare("a/b.FLARE.toml"));
  CHECK(!is_measured_flare("b.toml"));
  const MeasuredFlare flare = disc_flare(1.0);  // its ghost lies over the light
  const Frame frame = frame_on_sensor(ideal_lens_of(flare), 120, 80);
  CHECK(frame.pixel_pitch_mm == test::approx(0.01));
  Light light;
  light.direction = direction_from_angles(15.0 * kRadian, 8.0 * kRadian);
  light.value = {3.0, 3.0, 3.0};
  const auto drawn = render(flare, std::span(&light, 1), frame);
  REQUIRE(drawn.has_value());
  CHECK(total(drawn->image) == test::approx(0.03 * std::numbers::pi).epsilon(0.01));
  const Vec3 d = light.direction;
  const Vec2 at = frame.pixel_from_sensor({d.x / d.z, d.y / d.z});
  CHECK(at.x > 60.0);  // right of the middle
  CHECK(at.y < 40.0);  // and above it
  CHECK(length(centroid(drawn->image) - at) < 0.05);
  light.direction = {0.0, 0.0, -1.0};
  CHECK(!render(flare, std::span(&light, 1), frame));
  MeasuredFlare fieldless = flare;
  fieldless.half_field.reset();
  light.direction = {0.0, 0.0, 1.0};
  const auto refused = render(fieldless, std::span(&light, 1), frame_on_sensor(ideal_lens_of(fieldless), 12, 8));
  REQUIRE(!refused);
  CHECK(refused.error().message.find("--hfov") != std::string::npos);
}

TEST_CASE("prediction: the ideal lens maps directions to points and back") {
  const LensState ideal = ideal_lens_of(disc_flare(1.0));
  const Vec3 direction = direction_from_angles(20.0 * kRadian, -10.0 * kRadian);
  const Vec2 at = chief_ray_image_point(ideal, direction, 550.0);
  CHECK(at.x == test::approx(direction.x / direction.z));
  CHECK(at.y == test::approx(direction.y / direction.z));
  const Vec3 back = direction_for_image_point(ideal, at, 550.0);
  CHECK(back.x == test::approx(direction.x));
  CHECK(back.y == test::approx(direction.y));
  CHECK(back.z == test::approx(direction.z));
}

TEST_CASE("prediction: lights beyond the measured angles are named") {
  const MeasuredFlare flare = disc_flare(1.0);
  std::array<Light, 2> lights;
  lights[1].direction = direction_from_angles(std::atan(0.55), 0.0);
  const auto warnings = range_warnings(flare, lights);
  REQUIRE(warnings.size() == 1);
  CHECK(warnings[0].find("faded to 50 per cent") != std::string::npos);
}

TEST_CASE("prediction: a map of a steady ghost is even, and falls to nothing beyond the measured angles") {
  LightMapSettings settings;
  settings.angles = 13;
  settings.directions = 3;
  const MeasuredFlare flare = disc_flare(0.0);
  settings.frame.frame = frame_on_sensor(ideal_lens_of(flare), 120, 80);
  const auto map = map_lights(flare, settings);
  REQUIRE(map.has_value());
  CHECK(map->is_quarter);
  CHECK(map->points.size() == 1 + 3 * 12);
  CHECK(std::tan(map->to_rad) == test::approx(0.6));
  for (const LightMapPoint& point : map->points) {
    const double left = std::clamp((0.6 - std::tan(point.angle_rad)) / 0.1, 0.0, 1.0);
    CHECK(point.figures.flare.sum == test::approx(0.01 * std::numbers::pi * left).epsilon(0.01));
  }
  settings.angles = 1;
  CHECK(!map_lights(flare, settings));
}

TEST_CASE("prediction: the map of a lens is what single lights give, by symmetry all around") {
  const auto lens = configure_lens(*find_lens("cooke-triplet"));
  REQUIRE(lens.has_value());
  LightMapSettings settings;
  settings.angles = 3;
  settings.directions = 3;
  settings.to_rad = 20.0 * kRadian;
  settings.frame.frame = frame_on_sensor(*lens, 72, 48);
  settings.frame.wavelengths = 3;
  const auto map = map_lights(*lens, settings);
  REQUIRE(map.has_value());
  const std::vector<double> sums = values_of(*map, Estimator::Sum);
  REQUIRE(sums.size() == 7);
  Light light;
  for (const double mirrored : {135.0, 225.0}) {
    const double sideways = std::sin(20.0 * kRadian);
    light.direction = {-sideways * std::cos(mirrored * kRadian), -sideways * std::sin(mirrored * kRadian),
                       std::cos(20.0 * kRadian)};
    const auto flare = render(AdaptiveOptions{}, *lens, std::span(&light, 1), settings.frame);
    REQUIRE(flare.has_value());
    CHECK(figures_of(flare->image)->sum == test::approx(sums[4]).epsilon(0.02));
  }
  CHECK(sums[0] > 0.0);
  CHECK(map_lights(*lens, settings, {.threads = 1})->points[6].figures.flare.sum == sums[6]);
}

TEST_CASE("prediction: a panorama's light has the value that its view's pixels sum to") {
  Image panorama(720, 360);
  for (int y = 150; y < 156; ++y) {  // 27 degrees up
    for (int x = 420; x < 428; ++x) {  // 32 degrees to the right
      for (int c = 0; c < 3; ++c) panorama.at(x, y, c) = 100.0F * static_cast<float>(c + 1);
    }
  }
  DetectionSettings detection;
  detection.threshold = 1.0;
  detection.softness = 0.0;
  const auto lights = lights_of_panorama(panorama, detection);
  REQUIRE(lights.has_value());
  REQUIRE(lights->size() == 1);
  const Frame frame{600, 400, 0, 0, 600, 400, 0.05};
  for (const CameraView view : {CameraView{}, CameraView{0.5, 0.2, 0.0}, CameraView{0.9, 0.1, 0.7}}) {
    const auto seen = lights_in_view(*lights, view, frame, 18.0);
    const auto picture = view_of_panorama(panorama, view, frame, 18.0);
    REQUIRE(seen.size() == 1);
    REQUIRE(picture.has_value());
    CHECK(total(*picture) == test::approx(seen[0].value[1]).epsilon(0.01));
    CHECK(seen[0].value[2] == test::approx(1.5 * seen[0].value[1]).epsilon(1e-5));
    const Vec3 d = seen[0].direction;
    CHECK(length(centroid(*picture) - frame.pixel_from_sensor(Vec2{d.x, d.y} * (18.0 / d.z))) < 1.0);
  }
  CHECK(lights_in_view(*lights, {std::numbers::pi, 0.0, 0.0}, frame, 18.0).empty());
  CHECK(!lights_of_panorama(Image(100, 100)));
  CHECK(!view_of_panorama(Image(100, 100), {}, frame, 18.0));
}
