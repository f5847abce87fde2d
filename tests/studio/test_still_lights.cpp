// SPDX-License-Identifier: Apache-2.0
// Lights that stand still are drawn once while others move.
#include "studio/core/still_lights.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <doctest/doctest.h>

#include "contrejour/expert/settings.h"
#include "contrejour/render.h"
#include "studio/core/document.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

PictureRequest request_of(int count, double moved = 0.0) {
  PictureRequest request;
  for (int k = 0; k < count; ++k) {
    Light light;
    light.direction = normalized({0.01 * k + (k == 3 ? moved : 0.0), 0.02, 1.0});
    light.value = {1.0 + k, 1.0, 1.0};
    request.lights.push_back(light);
  }
  return request;
}

// A flare of one pixel, which is the sum of the lights' values.
struct CountingDraw {
  int lights = 0;
  Result<Flare> operator()(const PictureRequest& request) {
    lights += static_cast<int>(request.lights.size());
    Flare flare;
    flare.image = Image(1, 1);
    for (const Light& light : request.lights)
      for (int c = 0; c < 3; ++c)
        flare.image.at(0, 0, c) += static_cast<float>(light.value[static_cast<std::size_t>(c)]);
    return flare;
  }
};

TEST_CASE("lights that stand still are drawn once, and are in every flare") {
  StillLights still;
  CountingDraw draw;
  const auto drawn = [&](const PictureRequest& request, const std::string& key) {
    draw.lights = 0;
    const auto flare = still.draw(request, key, std::ref(draw));
    REQUIRE(flare.has_value());
    CHECK(flare->image.at(0, 0, 0) == test::approx(465.0));  // of thirty lights, wherever they are
    return draw.lights;
  };
  CHECK(drawn(request_of(30), "a") == 30);
  CHECK(drawn(request_of(30, 0.01), "a") == 30);
  CHECK(still.drawn_time_ms() == still.kept_time_ms());
  CHECK(drawn(request_of(30, 0.02), "a") == 1);
  CHECK(still.drawn_time_ms() == 0.0);
  CHECK(drawn(request_of(30, 0.03), "a") == 1);
  CHECK(drawn(request_of(30, 0.04), "b") == 30);  // of another size, say
  PictureRequest brighter = request_of(30, 0.05);
  std::swap(brighter.lights[1].value, brighter.lights[2].value);
  CHECK(drawn(brighter, "b") == 30);
  CHECK(drawn(request_of(30, 0.06), "b") == 3);  // the other 27 are those kept
  still.forget();
  CHECK(drawn(request_of(30, 0.07), "b") == 30);
}

TEST_CASE("one light, or none that stands still, is drawn as it is") {
  StillLights still;
  CountingDraw draw;
  for (int k = 0; k < 3; ++k) {
    PictureRequest request = request_of(1);
    request.lights.front().direction = normalized({0.1 * k, 0.0, 1.0});
    REQUIRE(still.draw(request, "", std::ref(draw)).has_value());
  }
  CHECK(draw.lights == 3);
  CHECK(still.kept_time_ms() == 0.0);
}

TEST_CASE("a draft with lights that stand still is the picture of all lights, to the draft's error") {
  Document d = first_document();
  d = *with_value(d, "size", "96x64");
  const params::Values values = d.values();
  const LensState lens = *params::lens_of(*d.lens, values);
  auto renderer = Renderer::create();
  REQUIRE(renderer.has_value());
  REQUIRE(renderer->set_lens(lens).has_value());
  auto request = picture_request(values, lens);
  REQUIRE(request.has_value());
  const Light first = request->lights.front();
  for (int k = 1; k < 4; ++k) {
    request->lights.push_back(first);
    request->lights.back().direction = normalized(first.direction + Vec3{0.05 * k, 0.02 * k, 0.0});
  }
  const auto draw = [&](const PictureRequest& of) { return render_picture(of, *renderer); };
  StillLights still;
  Image last;
  for (int k = 0; k < 3; ++k) {
    request->lights.front().direction = normalized(first.direction + Vec3{-0.01 * k, 0.0, 0.0});
    const auto flare = still.draw(*request, key_without_lights(values), draw);
    REQUIRE(flare.has_value());
    last = flare->image;
  }
  CHECK(still.kept_time_ms() > 0.0);
  CHECK(still.drawn_time_ms() == 0.0);
  const auto whole = draw(*request);
  REQUIRE(whole.has_value());
  double difference = 0.0, peak = 0.0;
  for (std::size_t k = 0; k < last.pixels.size(); ++k) {
    difference += std::pow(static_cast<double>(last.pixels[k]) - static_cast<double>(whole->image.pixels[k]), 2.0);
    peak = std::max(peak, static_cast<double>(whole->image.pixels[k]));
  }
  CHECK(std::sqrt(difference / static_cast<double>(last.pixels.size())) < 0.005 * peak);
}

TEST_CASE("the key is of all values but those of lights") {
  params::Values values;
  REQUIRE(values.set("fnumber", "8").has_value());
  const std::string key = key_without_lights(values);
  REQUIRE(values.set("light-at", "0.3,0.4:2").has_value());
  CHECK(key_without_lights(values) == key);
  REQUIRE(values.set("size", "64x48").has_value());
  CHECK(key_without_lights(values) != key);
}

}  // namespace
}  // namespace contrejour::studio
