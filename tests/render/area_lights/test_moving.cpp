// SPDX-License-Identifier: Apache-2.0
// Frames blurred by the motion of their ghosts, while the lens and a light change, against sums of sharp frames.
#include <cmath>
#include <functional>
#include <string>

#include <doctest/doctest.h>

#include "contrejour/expert/metrics.h"
#include "contrejour/renderer.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// A lens and a light at a time from 0 to 1.
struct Shot {
  std::string name;
  const char* lens;
  std::function<LensSettings(double)> lens_at;
  std::function<Vec2(double)> light_at;  // u, v
  double least_db, least_gain_db;
};

struct Moment {
  LensState lens;
  std::vector<Light> lights;
};

Moment moment_of(const Shot& shot, double time) {
  Moment moment{test::bundled(shot.lens, shot.lens_at(time)), {}};
  moment.lights = {test::light_at(moment.lens, frame_on_sensor(moment.lens, 160, 106), shot.light_at(time))};
  return moment;
}

FrameSettings settings_of(const Moment& moment) { return test::green(frame_on_sensor(moment.lens, 160, 106)); }

Image drawn(Renderer& renderer, const Moment& moment, const FrameSettings& settings) {
  REQUIRE(renderer.set_lens(moment.lens));
  auto flare = renderer.render(moment.lights, settings);
  REQUIRE(flare);
  return std::move(flare->image);
}

// Sharp frames over the times of a window about a time.
Image mean_of(const Shot& shot, double time, const TimeWindow& window, double error) {
  constexpr int kCount = 48;
  auto renderer = Renderer::create(AdaptiveOptions{error});
  REQUIRE(renderer);
  Image mean(160, 106);
  double weights = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const double at = std::lerp(window.rise_from, window.fall_to, (k + 0.5) / kCount);
    const Moment moment = moment_of(shot, time + at);
    const Image one = drawn(*renderer, moment, settings_of(moment));
    const double weight = weight_at(window, at);
    weights += weight;
    for (std::size_t i = 0; i < one.pixels.size(); ++i) mean.pixels[i] += static_cast<float>(weight) * one.pixels[i];
  }
  for (float& sample : mean.pixels) sample /= static_cast<float>(weights);
  return mean;
}

double db_between(const Image& a, const Image& b) { return compare(a, b).value().psnr_db.value_or(1000.0); }

const auto kStill = [](double) { return Vec2{0.7, 0.33}; };
const auto kMoving = [](double time) { return Vec2{0.65 + 0.1 * time, 0.33 + 0.05 * time}; };
const auto kZoom = [](double time) { return LensSettings{.focal_length_mm = 135.0 + 6.0 * time, .f_number = 8.0}; };
const auto kFocus = [](double time) {
  return LensSettings{.f_number = 8.0, .object_distance_mm = 1.0 / (1.0 / 900.0 - time / 3600.0)};
};
const auto kIris = [](double time) { return LensSettings{.f_number = 8.0 + time}; };

}  // namespace

TEST_CASE("a drawing that is blurred by the motion of its ghosts is the mean of sharp frames") {
  const Shot shots[] = {{"a zoom", "canon-70-200", kZoom, kStill, 45.0, 3.0},
                        {"a zoom and a light that moves", "canon-70-200", kZoom, kMoving, 41.0, 10.0},
                        {"a rack focus", "heliar", kFocus, kStill, 55.0, 3.0},
                        // Some of the Tessar's ghosts are cut by rims, which do not move.
                        {"an iris that closes", "tessar", kIris, kStill, 42.0, 3.0}};
  for (const Shot& shot : shots) {
    CAPTURE(shot.name);
    constexpr double kAfter = 0.05;
    const TimeWindow window{-0.3, 0.0, 0.0, 0.3};
    auto renderer = Renderer::create(AdaptiveOptions{0.001});
    REQUIRE(renderer);
    const Moment middle = moment_of(shot, 0.5), later = moment_of(shot, 0.5 + kAfter);
    const Image sharp = drawn(*renderer, middle, settings_of(middle));
    renderer->set_motion(FrameMotion{later.lens, later.lights, kAfter, window});
    const Image blurred = drawn(*renderer, middle, settings_of(middle));
    const Image mean = mean_of(shot, 0.5, window, 0.002);
    const double sharp_db = db_between(mean, sharp), blurred_db = db_between(mean, blurred);
    CHECK(blurred_db > shot.least_db);
    CHECK(blurred_db > sharp_db + shot.least_gain_db);
  }
}
