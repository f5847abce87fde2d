// SPDX-License-Identifier: Apache-2.0
// Means over an exposure against integrals of moving shapes, computed here.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/exposure.h"
#include "contrejour/expert/metrics.h"

namespace contrejour {
namespace {

constexpr int kWidth = 120, kHeight = 3;

// A bar of even brightness from one place to another, by how much of each pixel it covers.
Image bar(double from, double to, double value = 1.0) {
  Image image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) =
            static_cast<float>(value * std::clamp(std::min(to, x + 1.0) - std::max(from, x + 0.0), 0.0, 1.0));
  return image;
}

DrawAtTimes moving(const std::function<Image(double)>& at) {
  return [at](const ExposureTimes& times, const Context&) -> Result<LayeredFlare> {
    return LayeredFlare{at(times.parameters), {}, {}};
  };
}

// The mean of very many.
Image mean_of(const std::function<Image(double)>& at) {
  constexpr int kCount = 2000;
  Image mean(kWidth, kHeight);
  for (int k = 0; k < kCount; ++k) {
    const Image one = at((k + 0.5) / kCount);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) mean.pixels[i] += one.pixels[i] / kCount;
  }
  return mean;
}

double error_of(const Image& image, const Image& exact) {
  const auto comparison = compare(exact, image);
  REQUIRE(comparison);
  return comparison->psnr_db ? std::pow(10.0, -*comparison->psnr_db / 20.0) : 0.0;
}

struct Shape {
  std::string name;
  std::function<Image(double)> at;
  int most_drawn;
};

}  // namespace

TEST_CASE("the mean of a moving shape keeps the error, with fewer drawings the less it moves") {
  const Shape shapes[] = {
      {"a wide bar that moves by 20 pixels", [](double t) { return bar(20 + 20 * t, 60 + 20 * t); }, 65},
      {"a wide bar that moves by half a pixel", [](double t) { return bar(20.2 + 0.5 * t, 60.2 + 0.5 * t); }, 5},
      {"a line that moves by ten times its width", [](double t) { return bar(20 + 30 * t, 23 + 30 * t); }, 129},
      {"a bar that grows", [](double t) { return bar(40 - 10 * t, 50 + 20 * t, 1.0 / (1.0 + 3.0 * t)); }, 65},
      {"a bar that fades", [](double t) { return bar(40, 50, 1.0 - 0.5 * t); }, 3}};
  for (const Shape& shape : shapes) {
    CAPTURE(shape.name);
    const Image exact = mean_of(shape.at);
    for (const double error : {0.02, 0.003}) {
      CAPTURE(error);
      const auto exposed = expose(moving(shape.at), {.error = error});
      REQUIRE(exposed);
      CHECK(exposed->error <= error);
      CHECK(error_of(exposed->flare.image, exact) <= error + 1e-5);
      CHECK(exposed->drawn <= shape.most_drawn);
    }
  }
}

TEST_CASE("what does not change is drawn at the two ends and keeps its pixels") {
  const auto still = [](double) { return bar(20.25, 40.5); };
  const auto exposed = expose(moving(still), {});
  REQUIRE(exposed);
  CHECK(exposed->drawn == 2);
  CHECK(exposed->flare.image.pixels == still(0).pixels);
}

TEST_CASE("a change that turns back in the middle is found where it may") {
  const auto at = [](double t) { return bar(20 + 20 * std::abs(t - 0.5), 60 + 20 * std::abs(t - 0.5)); };
  const auto exposed = expose(moving(at), {.error = 0.01, .may_turn_back = true});
  REQUIRE(exposed);
  CHECK(error_of(exposed->flare.image, mean_of(at)) <= 0.01);
}

TEST_CASE("moving lights are drawn on their way at once where the parameters' change does not show") {
  const auto with_change = [](double change) {
    return [change](const ExposureTimes& times, const Context&) -> Result<LayeredFlare> {
      const bool is_swept = times.lights_from == 0.0 && times.lights_to == 1.0;
      const double light = is_swept ? 70.0 : 10.0 + 40.0 * times.lights_from;
      return LayeredFlare{bar(light + change * times.parameters, light + change * times.parameters + 10.0), {}, {}};
    };
  };
  const auto swept = expose(with_change(1e-4), {.lights_move = true});
  REQUIRE(swept);
  CHECK(swept->drawn == 3);
  CHECK(swept->flare.image.at(75, 1) == 1.0F);
  const auto drawn = expose(with_change(30.0), {.error = 0.01, .lights_move = true});
  REQUIRE(drawn);
  CHECK(drawn->drawn > 5);
  CHECK(error_of(drawn->flare.image, mean_of([](double t) { return bar(10 + 70 * t, 20 + 70 * t); })) <= 0.01);
}

TEST_CASE("layers are averaged in rectangles that grow, and sum to the flare") {
  const auto draw = [](const ExposureTimes& times, const Context&) -> Result<LayeredFlare> {
    const int at = 10 + static_cast<int>(40 * times.parameters);
    Image part(8, 2);
    std::ranges::fill(part.pixels, 0.5F);
    LayeredFlare flare{Image(kWidth, kHeight), {{"dark", {}, 0, 0}, {"moving", part, at, 1}}, {}};
    if (times.parameters < 0.5) flare.layers.push_back({"early", part, 80, 0});
    flare.statistics.method = "bars";
    flare.statistics.rays = 10;
    for (const FlareLayer& layer : flare.layers)
      for (int y = 0; y < layer.image.height; ++y)
        for (int x = 0; x < layer.image.width; ++x)
          for (int c = 0; c < 3; ++c) flare.image.at(layer.left + x, layer.top + y, c) += layer.image.at(x, y, c);
    return flare;
  };
  const auto exposed = expose(draw, {.error = 0.01});
  REQUIRE(exposed);
  const auto& layers = exposed->flare.layers;
  REQUIRE(layers.size() == 3);
  CHECK(layers[0].name == "dark");
  CHECK(layers[0].image.pixels.empty());
  Image sum(kWidth, kHeight);
  for (const FlareLayer& layer : layers) {
    const Image whole = whole_image(layer, kWidth, kHeight);
    for (std::size_t k = 0; k < sum.pixels.size(); ++k) sum.pixels[k] += whole.pixels[k];
  }
  CHECK(error_of(sum, exposed->flare.image) < 1e-6);
  CHECK(exposed->flare.statistics.rays == 10U * static_cast<unsigned>(exposed->drawn));
}

TEST_CASE("progress rises and ends at 1") {
  for (const double error : {0.05, 0.003}) {
    std::vector<double> reported;
    const Context context{.progress = [&](double done) { reported.push_back(done); }};
    const auto exposed =
        expose(moving([](double t) { return bar(20 + 20 * t, 60 + 20 * t); }), {.error = error}, context);
    REQUIRE(exposed);
    CHECK(reported.size() == static_cast<std::size_t>(exposed->drawn) + 1);
    CHECK(std::ranges::is_sorted(reported));
    CHECK(reported.back() == 1.0);
  }
}

TEST_CASE("drawing stops at the limit, at an error and where it is cancelled") {
  int count = 0;
  const auto flicker = [&](const ExposureTimes&, const Context&) -> Result<LayeredFlare> {
    return LayeredFlare{bar(10, ++count % 2 == 0 ? 90 : 11), {}, {}};
  };
  const auto limited = expose(flicker, {.error = 1e-6, .max_intervals = 8});
  REQUIRE(limited);
  CHECK(limited->drawn == 9);
  CHECK(limited->error > 1e-6);
  const auto failing = [](const ExposureTimes& times, const Context&) -> Result<LayeredFlare> {
    if (times.parameters > 0.6) return failure(ErrorCode::InvalidArgument, "no such lens");
    return LayeredFlare{bar(10, 20), {}, {}};
  };
  const auto failed = expose(failing, {});
  REQUIRE(!failed);
  CHECK(failed.error().message == "no such lens");
  std::atomic<bool> cancel = true;
  const auto cancelled = expose(moving([](double) { return bar(10, 20); }), {}, Context{.cancel = &cancel});
  REQUIRE(!cancelled);
  CHECK(cancelled.error().code == ErrorCode::Cancelled);
}

}  // namespace contrejour
