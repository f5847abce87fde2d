// SPDX-License-Identifier: Apache-2.0
// Extended lights, as `render` draws them, against sums of many points.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/moving_light.h"
#include "support/approx.h"
#include "support/flares.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// Points spread evenly over a disc (Vogel's spiral).
std::vector<Light> points_over(const Light& disc, int count) {
  std::vector<Light> points;
  for (int k = 0; k < count; ++k) {
    const double r = std::tan(disc.radius_rad) * std::sqrt((k + 0.5) / count),
                 rotation = k * kPi * (3.0 - std::sqrt(5.0));
    Light point = disc;
    point.radius_rad = 0.0;
    point.direction = offset_direction(disc.direction, {r * std::cos(rotation), r * std::sin(rotation)});
    for (double& v : point.value) v /= count;
    points.push_back(point);
  }
  return points;
}

double psnr_db(const Image& a, const Image& b) { return compare(a, b).value().psnr_db.value_or(1000.0); }

Light sun(double azimuth_rad, double elevation_rad) {
  Light light;
  light.direction = direction_from_angles(azimuth_rad, elevation_rad);
  light.radius_rad = kSunRadius_rad;
  return light;
}

// The centroid of the green channel, in pixels.
Vec2 centroid_of(const Image& image) {
  Vec2 sum;
  double weights = 0.0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double w = image.at(x, y, 1);
      sum = sum + Vec2{x + 0.5, y + 0.5} * w;
      weights += w;
    }
  }
  return sum * (1.0 / weights);
}

}  // namespace

TEST_CASE("the sun is the sum of points over its disc [slow]") {
  struct Case {
    const char* lens;
    double f_number;
    double min_db;
    Vec2 angles_rad;
  };
  // Two of the Tessar's ghosts are special: one is a sliver, and of another the sun's middle lights only a part. The
  // Heliar's are cut by rims.
  const Case cases[] = {{"planar-50", 8.0, 50.0, {0.17, 0.1}},
                        {"tessar", 11.0, 43.0, {0.17, 0.1}},
                        {"heliar", 16.0, 41.0, {-0.12, 0.15}}};
  for (const auto& [name, f_number, min_db, angles] : cases) {
    CAPTURE(name);
    const LensState lens = test::bundled(name, {.f_number = f_number, .iris = {7}});
    test::Settings settings = test::green(frame_on_sensor(lens, 240, 160));
    settings.set_error(0.001);
    const Light light = sun(angles.x, angles.y);
    const Flare ours = test::flare_of("adaptive", lens, {&light, 1}, settings);
    const Flare truth = test::flare_of("adaptive", lens, points_over(light, 150), settings);
    Light point = light;
    point.radius_rad = 0.0;
    const Flare still = test::flare_of("adaptive", lens, {&point, 1}, settings);
    const double db = psnr_db(truth.image, ours.image);
    CHECK(db > min_db);
    CHECK(db > psnr_db(truth.image, still.image) + 6.0);
  }
}

TEST_CASE("large lights are the sum of points over them, whose caustics and rims they move differently [slow]") {
  struct Case {
    const char* lens;
    LensSettings settings;
    Frame (*frame)(const LensState&);
    double degrees, min_db;
    Vec2 angles_rad;
  };
  const auto sensor = [](const LensState& lens) { return frame_on_sensor(lens, 160, 106); };
  const auto narrow = [](const LensState& lens) {
    Frame frame = frame_on_sensor(lens, 160, 130);
    frame.pixel_pitch_mm = 2.0 * lens.focal_length_mm * std::tan(10.5 * kPi / 180.0) / frame.width;
    return frame;
  };
  const Case cases[] = {{"planar-50", {}, narrow, 2.0, 45.0, {-3.4 * kPi / 180.0, 4.0 * kPi / 180.0}},
                        {"nikon-80-200", {.focal_length_mm = 140.0, .f_number = 16.0}, sensor, 2.0, 42.5, {0.05, 0.03}},
                        {"canon-70-200", {.focal_length_mm = 70.0, .f_number = 8.0}, sensor, 1.0, 48.0, {0.1, 0.06}}};
  for (const Case& at : cases) {
    CAPTURE(at.lens);
    const LensState lens = test::bundled(at.lens, at.settings);
    test::Settings settings = test::green(at.frame(lens));
    Light light = sun(at.angles_rad.x, at.angles_rad.y);
    light.radius_rad = 0.5 * at.degrees * kPi / 180.0;
    const Image ours = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
    settings.set_error(0.001);
    const Image truth = test::flare_of("adaptive", lens, points_over(light, 120), settings).image;
    CHECK(psnr_db(truth, ours) > at.min_db);
    CHECK(test::sum(ours) == test::approx(test::sum(truth)).epsilon(0.015));
  }
}

TEST_CASE("a light that moves has the flare of lights along its path [slow]") {
  struct Case {
    const char* lens;
    double f_number;
    Vec2 to_rad;
  };
  constexpr int kPoints = 128;
  for (const auto& [name, f_number, to] : {Case{"heliar", 8.0, {0.05, 0.01}}, {"tessar", 11.0, {-0.02, 0.04}}}) {
    CAPTURE(name);
    const LensState lens = test::bundled(name, {.f_number = f_number, .iris = {7}});
    test::Settings settings = test::green(frame_on_sensor(lens, 240, 160));
    const Vec3 from = direction_from_angles(0.1, 0.06);
    const Light light = swept_light({.direction = from}, std::vector{from, offset_direction(from, to)});
    std::vector<Light> points;
    for (int k = 0; k < kPoints; ++k)
      points.push_back({.direction = offset_direction(from, to * ((k + 0.5) / kPoints)),
                        .value = {1.0 / kPoints, 1.0 / kPoints, 1.0 / kPoints}});
    settings.set_error(0.001);
    const Image truth = test::flare_of("adaptive", lens, points, settings).image;
    const Image ours = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
    CHECK(psnr_db(truth, ours) > 45.0);
    CHECK(test::sum(ours) == test::approx(test::sum(truth)).epsilon(0.01));
  }
}

TEST_CASE("many lights with a size take at most four times as long as points [slow]") {
  const LensState lens = test::bundled("planar-50", {});
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 240, 160);
  // A pane with spots next to it, as merged areas of a photograph have; each has its own colours.
  Image level(40, 40, 3);
  for (int k = 0; k < 1600; ++k)
    for (int c = 0; c < 3; ++c)
      level.at(k % 40, k / 40, c) = (k % 40 / 8 == 2 && k / 40 / 8 == 2) || k % 97 == 0 ? 1.0F + (k + c) % 3 : 0.0F;
  const double pixel = 0.002;
  std::vector<Light> points, shapes;
  for (int k = 0; k < 8; ++k) {
    points.push_back(test::light_at(lens, settings.frame, {0.15 + 0.1 * k, 0.2 + 0.3 * (k % 3)}));
    shapes.push_back(points.back());
    shapes.back().shape =
        std::make_shared<const LightShape>(LightShape{level, {20.0, 20.0}, {pixel, 0.0}, {0.0, -pixel}});
  }
  const auto seconds = [&](const std::vector<Light>& lights) {
    double smallest = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 2; ++run) {
      const std::clock_t start = std::clock();
      test::flare_of("adaptive", lens, lights, settings, {.threads = 1});
      smallest = std::min(smallest, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return smallest;
  };
  CHECK(seconds(shapes) < 4.0 * seconds(points));
}

TEST_CASE("every method blurs alike") {
  const LensState lens = test::bundled("heliar", {.f_number = 16.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 96, 64));
  settings.set_grid(96);
  settings.reference.density = 0.25;
  settings.selection = SelectList{{{3, 4}, {7, 9}}};
  Light light = sun(0.1, 0.05);
  light.radius_rad *= 3.0;
  const Image truth = test::flare_of("reference", lens, {&light, 1}, settings).image;
  for (const char* method : {"adaptive", "bundle", "tiled"})
    CHECK(psnr_db(truth, test::flare_of(method, lens, {&light, 1}, settings).image) > 40.0);
}

TEST_CASE(
    "a light with a size that moves steadily has a flare that does, though a ghost in focus is a spot or a line") {
  struct Case {
    const char* lens;
    double focal_length_mm, f_number;
    int first, count;  // frames of a motion by a tenth of a pixel each
    double limit;  // of the second difference in time, over the peak
  };
  // The Itoh's ghost 1-3 is a spot; the Heliar's 2-4 is a line 0.3 pixels wide and three pixels long.
  for (const Case& one : {Case{"itoh-zoom", 123.0, 32.0, 0, 12, 0.003}, Case{"heliar", 0.0, 16.0, 115, 4, 0.004}}) {
    CAPTURE(one.lens);
    LensSettings lens_settings{.f_number = one.f_number};
    if (one.focal_length_mm > 0.0) lens_settings.focal_length_mm = one.focal_length_mm;
    const LensState lens = test::bundled(one.lens, lens_settings);
    test::Settings settings = test::green(frame_on_sensor(lens, 160, 90));
    std::vector<Image> frames;
    for (int k = one.first; k < one.first + one.count; ++k) {
      Light light = test::light_at(lens, settings.frame, Vec2{0.70, 0.33} + Vec2{0.1 / 160, 0.03 / 90} * k);
      light.radius_rad = kSunRadius_rad;
      frames.push_back(test::flare_of("adaptive", lens, {&light, 1}, settings).image);
    }
    const double peak = quantile_of_samples(frames.front(), 0.999);
    for (std::size_t k = 2; k < frames.size(); ++k) {
      double squares = 0.0;
      for (std::size_t j = 0; j < frames[k].pixels.size(); ++j) {
        const double off = frames[k].pixels[j] - 2.0 * frames[k - 1].pixels[j] + frames[k - 2].pixels[j];
        squares += off * off;
      }
      CHECK(std::sqrt(squares / static_cast<double>(frames[k].pixels.size())) < one.limit * peak);
    }
  }
}

TEST_CASE("adaptive draws the pieces of a divided light as well as a frame, though their errors add up") {
  const LensState lens = test::bundled("planar-50", {.f_number = 1.4});
  test::Settings settings = test::green(frame_on_sensor(lens, 120, 80));
  settings.scope = GhostScope::All;
  settings.set_grid(96);
  Light light = test::light_at(lens, settings.frame, {0.7, 0.33});
  light.radius_rad = kPi / 180.0;
  const Image pieces = test::flare_of("bundle", lens, {&light, 1}, settings).image;
  // 43 where every image of pieces makes the error of a frame.
  CHECK(psnr_db(pieces, test::flare_of("adaptive", lens, {&light, 1}, settings).image) > 55.0);
}

TEST_CASE("the pieces of a divided light have the colours of points over it") {
  const LensState lens = test::bundled("heliar", {.f_number = 16.0});
  test::Settings settings;
  settings.frame = frame_on_sensor(lens, 160, 90);
  settings.selection = SelectList{{Ghost{3, 4}}};  // whose coloured rim crosses the frame's edge
  Light light = test::light_at(lens, settings.frame, {0.7424, 0.3533});
  light.radius_rad = kSunRadius_rad;
  const Flare ours = test::flare_of("adaptive", lens, {&light, 1}, settings);
  settings.set_error(1e-4);
  const Flare truth = test::flare_of("adaptive", lens, points_over(light, 60), settings);
  CHECK(psnr_db(truth.image, ours.image) > 50.0);  // 39 with bands as wide as a whole light may have
}

TEST_CASE("a spot much smaller than the light's image lies in its pixels as points over the light would") {
  const LensState lens = test::bundled("itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 160, 90));
  settings.selection = SelectList{{Ghost{1, 3}}};
  for (const double down_px : {0.0, 0.06, 0.12}) {
    Light light = test::light_at(lens, settings.frame, {0.7778, (33.42 + down_px) / 90});
    light.radius_rad = kSunRadius_rad;
    settings.set_error(0.003);
    const Flare ours = test::flare_of("adaptive", lens, {&light, 1}, settings);
    settings.set_error(1e-4);
    const Flare truth = test::flare_of("adaptive", lens, points_over(light, 200), settings);
    double off = 0.0, flux = 0.0;
    for (std::size_t k = 0; k < ours.image.pixels.size(); ++k) {
      off = std::max(off, std::abs(1.0 * ours.image.pixels[k] - truth.image.pixels[k]));
      flux += truth.image.pixels[k];
    }
    CHECK(off < 0.003 * flux);  // 0.008 where pixels do not keep its position
  }
}

TEST_CASE("size zero is the point, bit for bit; a very small disc is nearly that") {
  const LensState lens = test::bundled("heliar", {.f_number = 11.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 120, 80));
  Light light = sun(0.1, 0.05);
  light.radius_rad = 0.0;
  const Flare point = test::flare_of("adaptive", lens, {&light, 1}, settings);
  CHECK(light.is_point());
  light.radius_rad = 1e-9;
  const Flare small = test::flare_of("adaptive", lens, {&light, 1}, settings);
  CHECK(psnr_db(point.image, small.image) > 80.0);
  CHECK(small.statistics.ghosts_rendered == point.statistics.ghosts_rendered);
  CHECK(small.statistics.time_ms.back().first == "total");
}

TEST_CASE("the flux does not depend on the size") {
  // A ghost well within the frame, and one whose point is just outside it.
  const LensState lens = test::plate();
  for (const double shift_mm : {0.0, -4.5}) {
    Frame frame{240, 240, 0, 0, 240, 240, 0.05};
    frame.origin_x = static_cast<int>(shift_mm / frame.pixel_pitch_mm);
    test::Settings settings = test::green(frame);
    Light light;
    double flux = 0.0;
    for (const double radius : {0.0, 0.002, 0.01, 0.05, 0.15}) {
      light.radius_rad = radius;
      const double sum = test::sum(test::flare_of("adaptive", lens, {&light, 1}, settings).image);
      if (radius == 0.0) flux = sum;
      if (shift_mm == 0.0) CHECK(sum == test::approx(flux).epsilon(0.004));
      CHECK(sum > 0.2 * flux);
    }
  }
}

TEST_CASE("a shape's ghost is the shape, as the ghost turns it, and lies where points would") {
  const LensState lens = test::bundled("planar-50", {.f_number = 8.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 180, 120));
  settings.set_error(0.001);
  // An L of five squares, which differs from all its mirror images.
  Light light = sun(0.12, 0.07);
  light.radius_rad = 0.0;
  Image level(2, 4, 1);
  for (const auto& [x, y] : {std::pair{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 3}}) level.at(x, y) = 1.0F;
  const double pixel = 0.006;
  light.shape = std::make_shared<const LightShape>(LightShape{level, {1.0, 2.0}, {pixel, 0.0}, {0.0, -pixel}});
  std::vector<Light> points;
  constexpr int kEach = 6;
  for (const auto& [x, y] : {std::pair{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 3}}) {
    for (int k = 0; k < kEach * kEach; ++k) {
      Light point;
      const double u = x + (k % kEach + 0.5) / kEach - 1.0, v = y + (k / kEach + 0.5) / kEach - 2.0;
      point.direction = offset_direction(light.direction, {u * pixel, -v * pixel});
      for (double& value : point.value) value /= 5.0 * kEach * kEach;
      points.push_back(point);
    }
  }
  const Image ours = test::flare_of("adaptive", lens, {&light, 1}, settings).image;
  CHECK(psnr_db(test::flare_of("adaptive", lens, points, settings).image, ours) > 42.0);
}

TEST_CASE("the same for any number of threads; cancelled when asked; wrong extents refused") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  test::Settings settings = test::green(frame_on_sensor(lens, 150, 100));
  settings.starburst.on = true;
  Light light = sun(0.1, 0.05);
  const Flare one = test::flare_of("adaptive", lens, {&light, 1}, settings, {.threads = 1});
  const Flare three = test::flare_of("adaptive", lens, {&light, 1}, settings, {.threads = 3});
  CHECK(one.image.pixels == three.image.pixels);
  const std::atomic<bool> cancel = true;
  const auto stopped = render("adaptive", lens, {&light, 1}, settings, {.cancel = &cancel});
  REQUIRE_FALSE(stopped.has_value());
  CHECK(stopped.error().code == ErrorCode::Cancelled);
  Light nowhere = light;
  nowhere.direction.x = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(render("adaptive", lens, {&nowhere, 1}, settings).has_value());
  light.radius_rad = -1.0;
  const auto refused = render("adaptive", lens, {&light, 1}, settings);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::InvalidArgument);
}

// Two panes and a thin bar, over 48 x 48 pixels, which are as wide as a disc of this radius.
LightShape panes(double radius_rad) {
  constexpr int kPanes = 48;
  LightShape shape;
  shape.level = Image(kPanes, kPanes, 1);
  for (int y = 0; y < kPanes; ++y)
    for (int x = 0; x < kPanes; ++x)
      shape.level.at(x, y) =
          (y >= 4 && y < 36 && ((x >= 3 && x < 18) || (x >= 23 && x < 38))) || (y >= 41 && y < 43) ? 1.0F : 0.0F;
  const double pixel = 2.0 * std::tan(radius_rad) / kPanes;
  shape.centre_px = {0.5 * kPanes, 0.5 * kPanes};
  shape.right = {pixel, 0.0};
  shape.down = {0.0, -pixel};
  return shape;
}

test::Settings starburst_alone(const LensState& lens, int width, int height) {
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, width, height);
  settings.selection = SelectList{};
  settings.starburst.on = true;
  return settings;
}

double flux_in(const Image& image, int x0, int y0, int side) {
  double sum = 0.0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x) sum += image.at(x, y, 1);
  return sum;
}

TEST_CASE("a disc's starburst is the sum of its points', and holds the light's value [slow]") {
  const LensState lens = test::bundled("heliar", {.f_number = 16.0, .iris = {6}});
  const test::Settings settings = starburst_alone(lens, 240, 160);
  Light light = sun(0.02, 0.01);
  light.radius_rad *= 4.0;
  const Image ours = test::flare_of("bundle", lens, {&light, 1}, settings).image;
  const Image truth = test::flare_of("bundle", lens, points_over(light, 1200), settings).image;
  CHECK(test::sum(ours) == test::approx(test::sum(truth)).epsilon(0.003));
  CHECK(psnr_db(truth, ours) > 35.0);
  // The tail outside the disc, as a ratio.
  for (const auto& [x, y] : {std::pair{10, 10}, {200, 20}, {60, 140}, {180, 80}})
    CHECK(flux_in(ours, x, y, 8) == test::approx(flux_in(truth, x, y, 8)).epsilon(0.03));
}

TEST_CASE("a disc's direct image lies where the light is, within a small part of a pixel") {
  const LensState lens = test::bundled("planar-50", {});
  const test::Settings settings = starburst_alone(lens, 120, 80);
  double last = 0.0;
  for (int k = 0; k < 5; ++k) {  // steps of a fifth of a pixel
    const double tangent = (10.1 + 0.2 * k) * settings.frame.pixel_pitch_mm / lens.focal_length_mm;
    Light light = sun(std::atan(tangent), 0.0);
    light.radius_rad = 1.5 * settings.frame.pixel_pitch_mm / lens.focal_length_mm;
    const double x = centroid_of(test::flare_of("bundle", lens, {&light, 1}, settings).image).x;
    if (k > 0) CHECK(x - last == test::approx(0.2).epsilon(0.05));
    last = x;
  }
}

TEST_CASE("a frame's shift moves the ghosts of lights with a size, too") {
  const LensState lens = test::plate();
  Frame frame{240, 240, 0, 0, 240, 240, 0.05};
  Light light;
  light.radius_rad = 0.02;
  const Vec2 before = centroid_of(test::flare_of("adaptive", lens, {&light, 1}, test::green(frame)).image);
  frame.shift_mm = {-7.25 * frame.pixel_pitch_mm, 4.5 * frame.pixel_pitch_mm};
  const Vec2 after = centroid_of(test::flare_of("adaptive", lens, {&light, 1}, test::green(frame)).image);
  CHECK(after.x - before.x == test::approx(7.25).epsilon(0.01));
  CHECK(after.y - before.y == test::approx(4.5).epsilon(0.01));
}

TEST_CASE("starburst and glare of wide lights add light everywhere, whatever their shape, and keep their flux") {
  for (const char* name : {"heliar", "schneider-anamorphic-31", "canon-70-200"}) {
    CAPTURE(name);
    const LensState lens = test::bundled(name, {.f_number = 8.0, .iris = {6, 0.3}});
    test::Settings settings = starburst_alone(lens, 320, 214);
    settings.starburst.gain = 10.0;
    settings.glare = {0.1, 0.002};
    Light light = test::light_at(lens, settings.frame, {0.62, 0.4});
    light.value = {1000.0, 300.0, 100.0};
    const Image point = test::flare_of("bundle", lens, {&light, 1}, settings).image;
    for (const double across : {0.25, 0.1, 0.01}) {
      const double radius_rad = std::atan(0.5 * across * 320 * settings.frame.pixel_pitch_mm / lens.focal_length_mm);
      for (const bool is_disc : {true, false}) {
        CAPTURE(across);
        CAPTURE(is_disc);
        Light wide = light;
        wide.radius_rad = is_disc ? radius_rad : 0.0;
        wide.shape = is_disc ? nullptr : std::make_shared<const LightShape>(panes(radius_rad));
        const Image drawn = test::flare_of("bundle", lens, {&wide, 1}, settings).image;
        CHECK(*std::ranges::min_element(drawn.pixels) >= 0.0F);
        CHECK(test::sum(drawn) == test::approx(test::sum(point)).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("lights whose images are drawn may be others than the ghosts'") {
  const LensState lens = test::bundled("heliar", {.f_number = 16.0});
  test::Settings settings;
  settings.wavelengths = 3;
  settings.frame = frame_on_sensor(lens, 120, 80);
  settings.selection = SelectList{};
  settings.starburst.on = true;
  const Light ghosts = test::light_at(lens, settings.frame, {0.5, 0.5});
  const Light image = test::light_at(lens, settings.frame, {0.25, 0.25});
  settings.starburst.lights = std::make_shared<const std::vector<Light>>(std::vector{image});
  const Flare other = test::flare_of("bundle", lens, {&ghosts, 1}, settings);
  settings.starburst.lights = nullptr;
  CHECK(other.image.pixels == test::flare_of("bundle", lens, {&image, 1}, settings).image.pixels);
}
