// SPDX-License-Identifier: Apache-2.0
// The plug-in's pictures are the library's, however a host lays out its pixels and splits its frames.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "contrejour/apply.h"
#include "scenes.h"
#include "support/approx.h"
#include "support/scratch_folder.h"

using namespace contrejour;
using namespace contrejour::openfx;

namespace {

// The street as the library has it, rows from the top.
Image image_of(HostPicture& picture) {
  Image image(picture.width(), picture.height());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = picture.at(picture.bounds.x1 + x, picture.bounds.y2 - 1 - y, c);
  return image;
}

// Disjoint windows that cover the bounds, in random order.
std::vector<RectI> random_windows(const RectI& bounds, std::mt19937& random) {
  std::vector<RectI> windows;
  for (int y = bounds.y1; y < bounds.y2;) {
    const int y2 = std::min(bounds.y2, y + 1 + static_cast<int>(random() % 30));
    for (int x = bounds.x1; x < bounds.x2;) {
      const int x2 = std::min(bounds.x2, x + 1 + static_cast<int>(random() % 50));
      windows.push_back({x, y, x2, y2});
      x = x2;
    }
    y = y2;
  }
  std::shuffle(windows.begin(), windows.end(), random);
  return windows;
}

}  // namespace

TEST_CASE("openfx: a generator gives the library's flare bit for bit, whatever the rows, channels and origin") {
  const TestHost host;
  const Image expected = library_flare(values_of({{"light-at", kLightAt}}), "heliar");
  using Rows = HostPicture::Rows;
  for (const Rows rows : {Rows::Packed, Rows::Padded, Rows::Upwards}) {
    for (const int channels : {3, 4}) {
      Scene scene(host, context::kGenerator);
      scene.output = HostPicture::of(kBounds, channels, false, rows);
      REQUIRE(scene.render() == status::kOk);
      CHECK(differing_samples(scene.output, expected) == 0);
      if (channels == 4) CHECK(scene.output.at(0, 0, 3) == 1.0F);
    }
  }
  Scene scene(host, context::kGenerator, {-7, 100, -7 + kWidth, 100 + kHeight});
  scene.effect().properties.put<double>(name::kProjectOffset, {-7.0, 100.0});
  REQUIRE(scene.render() == status::kOk);
  CHECK(differing_samples(scene.output, expected) == 0);
}

TEST_CASE("openfx: half floats are the nearest to the library's values") {
  const TestHost host;
  const Image expected = library_flare(values_of({{"light-at", kLightAt}}), "heliar");
  Scene scene(host, context::kGenerator);
  scene.output = HostPicture::of(kBounds, 4, true, HostPicture::Rows::Upwards);
  REQUIRE(scene.render() == status::kOk);
  HostPicture rounded = HostPicture::of(kBounds, 4, true);
  int differing = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        rounded.set(x, y, c, expected.at(x, kHeight - 1 - y, c));
        if (rounded.at(x, y, c) != scene.output.at(x, y, c)) ++differing;
      }
  CHECK(differing == 0);
}

TEST_CASE("openfx: a filter finds lights and adds their flare as `apply` does, bit for bit") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  scene.effect().set("gain", {3.0});
  scene.effect().set("light1On", {1.0});
  REQUIRE(scene.render() == status::kOk);
  const auto values = values_of({{"gain", "3"}, {"light-at", kLightAt}});
  const auto lens = params::lens_of(*find_lens("heliar"), values);
  Picture picture = picture_of(image_of(scene.source));
  const auto applied = apply_flare(picture, *lens, values);
  REQUIRE(applied.has_value());
  REQUIRE(applied->plan.lights.size() == 2);
  CHECK(sum_of(scene.output) > sum_of(scene.source) + 1.0);
  CHECK(differing_samples(scene.output, picture.rgb) == 0);
  CHECK(scene.output.at(3, 3, 3) == 0.5F);
}

TEST_CASE("openfx: outputs, alphas and samples that are not finite") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  scene.source.set(5, 5, 1, std::numeric_limits<float>::infinity());
  scene.effect().choose("output", "flare");
  scene.effect().choose("alpha", "flare");
  REQUIRE(scene.render() == status::kOk);
  const float most = std::max({scene.output.at(9, 9, 0), scene.output.at(9, 9, 1), scene.output.at(9, 9, 2)});
  CHECK(scene.output.at(9, 9, 3) == std::clamp(most, 0.0F, 1.0F));
  scene.effect().choose("alpha", "0");
  scene.effect().choose("output", "detected lights");
  REQUIRE(scene.render() == status::kOk);
  CHECK(scene.output.at(45, 31, 0) == 4000.0F);
  CHECK(scene.output.at(5, 20, 0) == 0.0F);
  CHECK(scene.output.at(5, 20, 3) == 0.0F);
  scene.effect().choose("output", "source and flare");
  REQUIRE(scene.render() == status::kOk);
  CHECK(std::isinf(scene.output.at(5, 5, 1)));
}

TEST_CASE("openfx: the same pixels whatever the render windows, and none outside of them") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  REQUIRE(scene.render() == status::kOk);
  const std::vector<std::byte> whole = scene.output.memory;
  std::mt19937 random(7);
  for (int round = 0; round < 3; ++round) {
    std::ranges::fill(scene.output.memory, std::byte{0xff});
    for (const RectI& window : random_windows(kBounds, random))
      REQUIRE(scene.render({.window = window}) == status::kOk);
    CHECK(scene.output.memory == whole);
  }
  std::ranges::fill(scene.output.memory, std::byte{0xff});
  REQUIRE(scene.render({.window = {10, 10, 20, 20}}) == status::kOk);
  CHECK(std::isnan(scene.output.at(9, 10, 0)));
  CHECK(std::isnan(scene.output.at(10, 20, 0)));
  CHECK_FALSE(std::isnan(scene.output.at(19, 19, 0)));
}

TEST_CASE("openfx: a kept frame is not shown for another source, time or parameter [slow]") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  const RectI part{0, 0, kWidth, kHeight - 1};
  const auto rendered = [&] {
    REQUIRE(scene.render({.window = part}) == status::kOk);
    return scene.output.memory;
  };
  const auto first = rendered();
  for (int c = 0; c < 3; ++c) scene.source.set(45, 31, c, 8000.0F);
  const auto brighter = rendered();
  CHECK(first != brighter);
  scene.effect().set("stops", {1.0});
  CHECK(rendered() != brighter);
}

TEST_CASE("openfx: threads that render instances of their own, windows of one, and one instance for each frame") {
  const TestHost host;
  const Image expected = library_flare(values_of({{"light-at", kLightAt}}), "heliar");
  std::vector<std::thread> threads;
  std::atomic<int> differing = 0;
  Scene shared(host, context::kGenerator);
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (int frame = 0; frame < 2; ++frame) {
        Scene own(host, context::kGenerator);
        if (own.render() != status::kOk) ++differing;
        differing += differing_samples(own.output, expected);
      }
      const int rows = kHeight / 4;
      if (shared.render({.window = {0, k * rows, kWidth, (k + 1) * rows}}) != status::kOk) ++differing;
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(differing == 0);
  CHECK(differing_samples(shared.output, expected) == 0);
}

TEST_CASE("openfx: an aborted render ends soon and leaves the plug-in usable (threads)") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  scene.effect().choose("lens", "canon-70-200");
  scene.effect().set_text("method", "reference");
  scene.effect().set("density", {16.0});  // minutes of work
  std::atomic<int> questions = 0;
  scene.effect().aborts = [&] { return ++questions > 1 ? 1 : 0; };
  const auto start = std::chrono::steady_clock::now();
  CHECK(scene.render() == status::kOk);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK(questions > 1);
  scene.effect().aborts = {};
  scene.effect().choose("lens", "heliar");
  scene.effect().set_text("method", "adaptive");
  REQUIRE(scene.render() == status::kOk);
  CHECK(differing_samples(scene.output, library_flare(values_of({{"light-at", kLightAt}}), "heliar")) == 0);
}

TEST_CASE("openfx: frames in any order, with keys and with a file of lights [slow]") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  scene.effect().param("light1Position").keys = {{1.0, {0.2, 0.3}}, {5.0, {kLightX, kLightY}}};
  const auto frame_at = [&](double time) {
    REQUIRE(scene.render({.time = time, .window = kBounds}) == status::kOk);
    return scene.output.memory;
  };
  const auto third = frame_at(3.0), seventh = frame_at(7.0);
  CHECK(third != seventh);
  CHECK(frame_at(1.0) == third);
  CHECK(differing_samples(scene.output, library_flare(values_of({{"light-at", "0.2,0.7:20000"}}), "heliar")) == 0);

  const test::ScratchFolder folder;
  const auto file = folder / "lights.toml";
  std::ofstream(file) << "[[light]]\nat = { 1 = [0.2, 0.7], 5 = [0.75, 0.375] }\nvalue = 20000\n";
  scene.effect().set("light1On", {0.0});
  scene.effect().set_text("lightsFile", file.string());
  CHECK(frame_at(5.0) == seventh);
  CHECK(frame_at(1.0) == third);
  CHECK(frame_at(3.0) != third);
  CHECK(scene.effect().message.empty());
}

TEST_CASE("openfx: at a smaller render scale the picture is as bright, and wider pixels have the same sum [slow]") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  REQUIRE(scene.render() == status::kOk);
  const double whole = sum_of(scene.output);
  scene.output = HostPicture::of({0, 0, kWidth / 2, kHeight / 2});
  scene.effect().scale = 0.5;
  REQUIRE(scene.render({.window = scene.output.bounds, .scale = 0.5}) == status::kOk);
  CHECK(4.0 * sum_of(scene.output) == test::approx(whole).epsilon(0.05));
  scene.effect().scale = 1.0;
  scene.output = HostPicture::of({0, 0, kWidth / 2, kHeight});
  scene.output.pixel_aspect = 2.0;
  REQUIRE(scene.render({.window = scene.output.bounds}) == status::kOk);
  CHECK(sum_of(scene.output) == test::approx(whole).epsilon(0.05));
}

TEST_CASE("openfx: a draft while a parameter is dragged, if wanted [slow]") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  REQUIRE(scene.render() == status::kOk);
  const auto final_frame = scene.output.memory;
  const double sum = sum_of(scene.output);
  REQUIRE(scene.render({.window = kBounds, .is_interactive = true}) == status::kOk);
  CHECK(scene.output.memory != final_frame);
  CHECK(sum_of(scene.output) == test::approx(sum).epsilon(0.1));
  scene.effect().set("draft", {0.0});
  REQUIRE(scene.render({.window = kBounds, .is_interactive = true}) == status::kOk);
  CHECK(scene.output.memory == final_frame);
}

TEST_CASE("openfx: a fault is a message, and the source passes through bit for bit") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  paint_street(scene.source);
  scene.source.set(1, 1, 0, std::numeric_limits<float>::quiet_NaN());
  const auto faulty = [&](const char* parameter, const char* text, const char* part_of_message) {
    scene.effect().set_text(parameter, text);
    std::ranges::fill(scene.output.memory, std::byte{0});
    CHECK(scene.render() == status::kOk);
    CHECK(scene.output.memory == scene.source.memory);
    CHECK(scene.effect().message.find(part_of_message) != std::string::npos);
    const int messages = scene.effect().messages;
    CHECK(scene.render() == status::kOk);
    CHECK(scene.effect().messages == messages);  // once
    scene.effect().set_text(parameter, "");
    CHECK(scene.render() == status::kOk);
    CHECK(scene.effect().message.empty());
    CHECK(scene.output.memory != scene.source.memory);
  };
  faulty("lensFile", "/nowhere/lens.toml", "/nowhere/lens.toml");
  faulty("lookFile", "/nowhere/look.toml", "look.toml");
  faulty("lightsFile", "/nowhere/lights.toml", "lights.toml");
  faulty("select", "every one", "every one");
  faulty("light_at", "nonsense", "nonsense");
}

TEST_CASE("openfx: pixels that were not offered are refused") {
  const TestHost host;
  Scene scene(host, context::kFilter);
  scene.output.depth = "OfxBitDepthByte";
  CHECK(scene.render() == status::kErrImageFormat);
  CHECK_FALSE(scene.effect().message.empty());
  scene.output.depth = value::kHalf;  // the source's are floats
  CHECK(scene.render() == status::kErrImageFormat);
  scene.output.depth = value::kFloat;
  scene.output.row_bytes = 8;
  CHECK(scene.render() == status::kErrImageFormat);
  scene.effect().clip(clip::kOutput)->picture = nullptr;
  CHECK(scene.render() == status::kFailed);
}

#ifdef CONTREJOUR_CLI
TEST_CASE("openfx: the picture of the command line, bit for bit") {
  const TestHost host;
  const test::ScratchFolder folder;
  const auto file = folder / "flare.exr";
  const std::string command =
      fmt::format("{} render --preset bare-triplet --light-at {} --wavelengths {} --size {}x{} -o {} > /dev/null",
                  CONTREJOUR_CLI, kLightAt, kWavelengths, kWidth, kHeight, file.string());
  REQUIRE(std::system(command.c_str()) == 0);
  const auto picture = read_picture(file);
  REQUIRE(picture.has_value());
  Scene scene(host, context::kGenerator);
  scene.effect().choose("look", "bare-triplet");
  REQUIRE(scene.render() == status::kOk);
  CHECK(sum_of(scene.output) > 0.0);
  CHECK(differing_samples(scene.output, picture->rgb) == 0);
}
#endif
