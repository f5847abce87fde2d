// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "contrejour/expert/light_detection.h"
#include "contrejour/image_io.h"
#include "shared_data.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

DetectionSettings above(double threshold) {
  DetectionSettings settings;
  settings.threshold = threshold;
  return settings;
}

void fill(Image& image, int x0, int y0, int x1, int y1, const Rgb& value) {
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(value[static_cast<std::size_t>(c)]);
}

Rgb sum_of(const std::vector<DetectedLight>& lights) {
  Rgb sum{};
  for (const DetectedLight& light : lights)
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light.flux[c];
  return sum;
}

Image scattered_lights(int count) {
  Image image(400, 300);
  std::mt19937 random(5);
  for (int i = 0; i < count; ++i) {
    const int x = static_cast<int>(random() % 398), y = static_cast<int>(random() % 298);
    const double v = 20 + static_cast<double>(random() % 1000);
    fill(image, x, y, x + 1, y + 1, {v, v / 2, v / 3});
  }
  return image;
}

}  // namespace

TEST_CASE("known lights are found where they are, with their flux and size") {
  Image image(100, 60);
  fill(image, 0, 0, 99, 59, {0.4, 0.5, 0.6});  // lit surface
  fill(image, 20, 10, 23, 15, {50, 40, 30});   // 4 x 6
  fill(image, 80, 40, 80, 40, {0, 0, 300});    // a blue point, dim in luminance
  const Detection found = detect_lights(image, above(5)).value();
  REQUIRE(found.lights.size() == 2);
  const DetectedLight& lamp = found.lights[0];
  CHECK(lamp.centroid_px == Vec2{22, 13});
  CHECK(lamp.flux == Rgb{1200, 960, 720});
  CHECK(lamp.pixel_count == 24);
  CHECK(lamp.min_x == 20);
  CHECK(lamp.max_x == 23);
  CHECK(lamp.min_y == 10);
  CHECK(lamp.max_y == 15);
  CHECK(lamp.peak == 50);
  CHECK(lamp.rms_radius_px == test::approx(std::sqrt((16.0 + 36) / 12)));  // of a 4 x 6 rectangle
  CHECK(found.lights[1].centroid_px == Vec2{80.5, 40.5});
  CHECK(found.lights[1].flux == Rgb{0, 0, 300});
  CHECK(found.lights[1].rms_radius_px == test::approx(std::sqrt(1.0 / 6)));
}

TEST_CASE("areas connect over corners and round bends, and only so") {
  const char* const rows[] = {"#.#.....#", "#.#....#.", "###...#..", ".....#...",
                              "#........", ".#.###.#.", "...#.#.#.", "...#.###."};
  Image image(9, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 9; ++x)
      if (rows[y][x] == '#') fill(image, x, y, x, y, {9, 9, 9});
  const Detection found = detect_lights(image, above(1)).value();
  std::vector<std::int64_t> counts;
  for (const DetectedLight& light : found.lights) counts.push_back(light.pixel_count);
  CHECK(counts == std::vector<std::int64_t>{11, 7, 4, 2});
}

TEST_CASE("the threshold is soft: a light fades in, and above the ramp counts in full") {
  Image image(9, 9);
  double last = -1;
  for (double level = 9; level <= 14; level += 0.125) {
    fill(image, 4, 4, 4, 4, {level, level, level});
    const double flux = sum_of(detect_lights(image, above(10)).value().lights)[0];
    CHECK(flux >= last);
    CHECK(flux - std::max(last, 0.0) < 1.5);  // a hard threshold would jump by 10
    last = flux;
    if (level <= 10) CHECK(flux == 0);
    if (level >= 12.5) CHECK(flux == test::approx(level));
  }
  DetectionSettings hard = above(10);
  hard.softness = 0;
  fill(image, 4, 4, 4, 4, {10, 10, 10});
  CHECK(detect_lights(image, hard).value().lights.at(0).flux[0] == 10);
}

TEST_CASE("the tail is merged without losing flux") {
  const Image image = scattered_lights(120);
  DetectionSettings all = above(5);
  all.max_lights = 1000;
  const Detection whole = detect_lights(image, all).value();
  REQUIRE(whole.lights.size() > 80);
  for (const int largest : {1, 2, 7, 32}) {
    DetectionSettings few = above(5);
    few.max_lights = largest;
    const Detection merged = detect_lights(image, few).value();
    REQUIRE(merged.lights.size() == static_cast<std::size_t>(largest));
    CHECK(merged.areas_found == whole.areas_found);
    const Rgb sum = sum_of(merged.lights), expected = sum_of(whole.lights);
    for (std::size_t c = 0; c < 3; ++c) CHECK(sum[c] == test::approx(expected[c]).epsilon(1e-9));
    // The first moment is preserved as well.
    Vec2 moment{}, moment_expected{};
    int areas = 0;
    for (const auto& l : merged.lights) {
      moment = moment + l.flux[0] * l.centroid_px;
      areas += l.merged_areas;
    }
    for (const auto& l : whole.lights) moment_expected = moment_expected + l.flux[0] * l.centroid_px;
    CHECK(moment.x == test::approx(moment_expected.x).epsilon(1e-9));
    CHECK(moment.y == test::approx(moment_expected.y).epsilon(1e-9));
    CHECK(areas == whole.areas_found);
    for (std::size_t i = 1; i < merged.lights.size(); ++i)
      CHECK(merged.lights[i - 1].flux[0] >= merged.lights[i].flux[0]);
  }
}

TEST_CASE("a shifted picture has shifted lights and the same fluxes") {
  Image image(120, 90), shifted(120, 90);
  std::mt19937 random(9);
  for (int i = 0; i < 300; ++i) {
    const int x = 20 + static_cast<int>(random() % 60), y = 20 + static_cast<int>(random() % 40);
    const double v = static_cast<double>(random() % 4000) / 100;
    fill(image, x, y, x, y, {v, v, 0.3 * v});
    fill(shifted, x + 13, y - 7, x + 13, y - 7, {v, v, 0.3 * v});
  }
  const auto a = detect_lights(image, above(2)).value().lights, b = detect_lights(shifted, above(2)).value().lights;
  REQUIRE(a.size() == b.size());
  REQUIRE(a.size() > 5);
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(b[i].flux == a[i].flux);
    CHECK(b[i].centroid_px.x - a[i].centroid_px.x == test::approx(13).epsilon(1e-12));
    CHECK(b[i].centroid_px.y - a[i].centroid_px.y == test::approx(-7).epsilon(1e-12));
    CHECK(b[i].rms_radius_px == test::approx(a[i].rms_radius_px).epsilon(1e-9));
    CHECK(b[i].min_x == a[i].min_x + 13);
  }
}

TEST_CASE("a light that moves by a tenth of a pixel moves by a tenth of a pixel") {
  double last_x = 0;
  for (int step = 0; step < 30; ++step) {
    const double cx = 20 + 0.1 * step;
    Image image(60, 40);
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 60; ++x) {
        const double r2 = (x + 0.5 - cx) * (x + 0.5 - cx) + (y + 0.5 - 18.3) * (y + 0.5 - 18.3);
        fill(image, x, y, x, y, Rgb{100, 90, 80});
        for (int c = 0; c < 3; ++c) image.at(x, y, c) *= static_cast<float>(std::exp(-r2 / 8));
      }
    const Detection found = detect_lights(image, above(4)).value();
    REQUIRE(found.lights.size() == 1);
    CHECK(std::abs(found.lights[0].centroid_px.x - cx) < 0.02);
    CHECK(found.lights[0].flux[0] == test::approx(100 * 8 * std::numbers::pi).epsilon(0.06));
    if (step > 0) CHECK(std::abs(found.lights[0].centroid_px.x - last_x - 0.1) < 0.02);
    last_x = found.lights[0].centroid_px.x;
  }
}

TEST_CASE("NaN, infinite and negative samples are no light") {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN(),
                   kInfinity = std::numeric_limits<double>::infinity();
  Image image(20, 20);
  fill(image, 1, 1, 3, 3, {kNotANumber, kNotANumber, kNotANumber});
  fill(image, 6, 1, 8, 3, {kInfinity, kInfinity, kInfinity});
  fill(image, 11, 1, 13, 3, {-100, -100, -100});
  CHECK(detect_lights(image, above(1)).value().lights.empty());
  CHECK(detect_lights(image, {}).value().lights.empty());
  fill(image, 10, 10, 10, 10, {100, kNotANumber, -5});
  const auto lights = detect_lights(image, above(1)).value().lights;
  REQUIRE(lights.size() == 1);
  CHECK(lights[0].flux == Rgb{100, 0, 0});
}

TEST_CASE("small areas can be left out, and bad settings are errors") {
  Image image(20, 20);
  fill(image, 1, 1, 1, 1, {100, 100, 100});
  fill(image, 5, 5, 6, 6, {100, 100, 100});
  DetectionSettings settings = above(1);
  settings.min_pixels = 2;
  CHECK(detect_lights(image, settings).value().lights.size() == 1);
  CHECK(detect_lights(Image(), {}).value().lights.empty());
  CHECK_FALSE(detect_lights(Image(4, 4, 1), {}).has_value());
  CHECK_FALSE(detect_lights(image, above(-1)).has_value());
  CHECK_FALSE(detect_lights(image, above(std::nan(""))).has_value());
  settings.max_lights = 0;
  CHECK_FALSE(detect_lights(image, settings).has_value());
}

TEST_CASE("the automatic threshold takes lamps, small and large, and not paper") {
  Image image(200, 150);
  std::mt19937 random(1);
  for (float& v : image.pixels) v = 0.02F + 0.9F * static_cast<float>(random() % 1000) / 1000;
  fill(image, 100, 20, 150, 60, {2.5, 2.4, 2.2});  // sunlit paper
  CHECK(detect_lights(image, {}).value().lights.empty());
  fill(image, 10, 10, 12, 12, {400, 300, 200});
  CHECK(detect_lights(image, {}).value().lights.size() == 1);
  fill(image, 20, 70, 79, 129, {250, 250, 250});  // a globe over an eighth of the picture
  CHECK(detect_lights(image, {}).value().lights.size() == 2);

  Image black(50, 50);
  CHECK(detect_lights(black, {}).value().lights.empty());
  fill(black, 9, 9, 9, 9, {100, 100, 100});
  CHECK(detect_lights(black, {}).value().lights.size() == 1);

  Image clipped = image;  // as an 8-bit picture holds it
  for (float& v : clipped.pixels) v = std::min(v, 1.0F);
  CHECK(automatic_threshold(clipped).level == 0.8);
  CHECK(automatic_threshold(clipped).source == ThresholdSource::Clipped);
}

TEST_CASE("in the sample photographs: the flame, the lamps, and no paper") {
  if (const auto file = test::shared_data("hdr/openexr-images/ScanLines/CandleGlass.exr")) {
    const Detection found = detect_lights(read_picture(*file).value().rgb, {}).value();
    REQUIRE(found.lights.size() > 1);
    CHECK(std::abs(found.lights[0].centroid_px.x - 367) < 3);
    CHECK(std::abs(found.lights[0].centroid_px.y - 359) < 10);
    CHECK(found.lights[0].flux[0] > 50 * found.lights[1].flux[0]);
  }
  if (const auto file = test::shared_data("hdr/openexr-images/ScanLines/StillLife.exr")) {
    const Detection found = detect_lights(read_picture(*file).value().rgb, {}).value();
    REQUIRE(found.lights.size() > 2);
    CHECK(std::abs(found.lights[0].centroid_px.x - 378) < 5);
    CHECK(std::abs(found.lights[1].centroid_px.x - 859) < 5);
    CHECK(found.lights[1].flux[0] > 5 * found.lights[2].flux[0]);
  }
  if (const auto file = test::shared_data("hdr/openexr-images/ScanLines/Desk.exr")) {  // a stained-glass window
    const Detection found = detect_lights(read_picture(*file).value().rgb, {}).value();
    CHECK(found.source == ThresholdSource::Brightest);
    CHECK(found.threshold < 0.5 * found.brightest);
    REQUIRE_FALSE(found.lights.empty());
    const DetectedLight& first = found.lights[0];
    CHECK(first.min_x > 80);
    CHECK(first.max_x < 560);
    CHECK(first.max_y < 480);
    for (const DetectedLight& light : found.lights) CHECK(light.centroid_px.y < 600);  // not what it illuminates
  }
  if (const auto file = test::shared_data("hdr/openexr-images/ScanLines/Tree.exr")) {  // the sky behind it
    const Detection found = detect_lights(read_picture(*file).value().rgb, {}).value();
    CHECK(found.source == ThresholdSource::Brightest);
    REQUIRE_FALSE(found.lights.empty());
    CHECK(found.lights[0].centroid_px.y < 400);
    CHECK(found.lights[0].pixel_count > 10000);
  }
  if (const auto file = test::shared_data("hdr/openexr-images/ScanLines/Carrots.exr")) {  // only illuminated objects
    const Detection found = detect_lights(read_picture(*file).value().rgb, {}).value();
    CHECK(found.source == ThresholdSource::None);
    CHECK(found.lights.empty());
    CHECK(found.brightest == test::approx(0.9663).epsilon(1e-3));
    CHECK(found.brightest_px.x > 0.0);
  }
}

TEST_CASE("a window or a sky without a gap to what it lights: what is within two stops of the brightest") {
  // Levels spread evenly over ten stops, as of a window and the room that it lights: there is no gap.
  Image image(200, 100);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(100.0 * std::exp2(-0.06 * x));
  const Detection found = detect_lights(image, {}).value();
  CHECK(found.source == ThresholdSource::Brightest);
  CHECK(found.threshold == test::approx(25.0).epsilon(0.05));
  REQUIRE(found.lights.size() == 1);
  CHECK(found.lights[0].max_x == test::approx(33).epsilon(0.05));
  CHECK(found.brightest == 100.0);
  CHECK(found.brightest_px == Vec2{0.5, 0.5});

  for (float& v : image.pixels) v *= 1e-3F;  // all pixels below white
  CHECK(automatic_threshold(image).source == ThresholdSource::None);
  CHECK(detect_lights(image, {}).value().lights.empty());
}

TEST_CASE("lights are looked for within regions alone, and there more keenly") {
  Image image(100, 60);
  fill(image, 0, 0, 99, 59, {0.2, 0.2, 0.2});
  fill(image, 10, 10, 12, 12, {500, 500, 500});
  fill(image, 70, 40, 72, 42, {0.9, 0.9, 0.9});  // a lamp that is not brighter than white
  CHECK(detect_lights(image, {}).value().lights.size() == 1);
  DetectionSettings settings;
  settings.regions = {{60, 30, 100, 60}};
  const Detection dim = detect_lights(image, settings).value();
  CHECK(dim.source == ThresholdSource::Region);
  REQUIRE(dim.lights.size() == 1);
  CHECK(dim.lights[0].centroid_px == Vec2{71.5, 41.5});
  CHECK(dim.brightest == test::approx(0.9));
  settings.regions.push_back({-5, -5, 11, 1000});  // half of the other light; the region extends beyond the border
  const Detection both = detect_lights(image, settings).value();
  CHECK(both.source == ThresholdSource::Gap);
  REQUIRE(both.lights.size() == 1);
  CHECK(both.lights[0].pixel_count == 3);
  settings.regions = {{50, 0, 50, 60}, {80, 50, 20, 10}};  // without pixels
  CHECK(detect_lights(image, settings).value().lights.empty());
}
