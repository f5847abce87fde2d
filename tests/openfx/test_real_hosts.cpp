// SPDX-License-Identifier: Apache-2.0
// The plug-in in hosts that act as MLT and Natron do, by what their sources call and pass (docs/openfx.md).
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "contrejour/apply.h"
#include "mlt_host.h"
#include "natron_host.h"
#include "openfx/transfer.h"
#include "scenes.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::openfx;

namespace {

// A light by position in MLT's text, with pixels that are linear.
std::map<std::string, std::string> light_of_user() {
  return {{"detect", "0"},
          {"light1On", "1"},
          {"light1Position", "0.75 0.625"},
          {"wavelengths", kWavelengths},
          {"transfer", "linear"}};
}

MltImage grey_picture(int width, int height) {
  MltImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c) image.at(x, y, c) = static_cast<std::uint16_t>(c == 3 ? 40000 : 900 * c + 37 * x + y);
  return image;
}

// The 16-bit sample that the sum of a source's sample and a flare becomes.
std::uint16_t sum_of(std::uint16_t source, float flare, TransferCurve curve) {
  const float coded = static_cast<float>(source) * (1.0F / 65535.0F);
  if (!(flare > 0.0F)) return source;
  const double sum = curve == TransferCurve::Linear ? static_cast<double>(coded + flare)
                                                    : coded_from(linear_from(coded, curve) + flare, curve);
  return static_cast<std::uint16_t>(std::clamp(static_cast<float>(sum), 0.0F, 1.0F) * 65535.0F + 0.5F);
}

int wrong_samples(MltImage& result, MltImage& source, const Image& flare, TransferCurve curve) {
  int wrong = 0;
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      for (int c = 0; c < 3; ++c)
        if (result.at(x, y, c) != sum_of(source.at(x, y, c), flare.at(x, y, c), curve)) ++wrong;
      if (result.at(x, y, 3) != source.at(x, y, 3)) ++wrong;
    }
  return wrong;
}

}  // namespace

TEST_CASE("openfx: MLT takes the plug-in, in floats, and its users get every parameter") {
  const MltHost host;
  CHECK(host.depth() == value::kFloat);
  const auto offered = host.offered();
  CHECK(offered.size() > 90);
  for (const auto& [name, kind] : offered) {
    CAPTURE(name);
    CHECK_FALSE(kind.type.empty());
    // MLT computes what begins with this sign.
    CHECK_FALSE(kind.fallback.starts_with("@"));
  }
  // A pair of numbers is passed on whole only if it is a point or a size. Users drag a point, in fractions.
  CHECK(offered.at("light1Position").widget == "point");
  CHECK(offered.at("light1Position").is_normalised);
  CHECK(offered.at("lens").type == "string");
}

TEST_CASE("openfx: the library's flare in MLT's 16-bit pixels, to the last bit") {
  const MltHost host;
  MltImage source = grey_picture(kWidth, kHeight);
  const Image flare = library_flare(values_of({{"light-at", kLightAt}}), "heliar");
  REQUIRE(*std::ranges::max_element(flare.pixels) > 0.01F);
  auto user = light_of_user();
  for (const TransferCurve curve : {TransferCurve::Linear, TransferCurve::Srgb}) {
    MltImage result = source;
    if (curve == TransferCurve::Srgb) user.erase("transfer");  // the default there
    host.filter(result, user, {kWidth, kHeight}, 3);
    CHECK(result.samples != source.samples);
    CHECK(wrong_samples(result, source, flare, curve) == 0);
  }
  user["lens"] = "tessar";  // menus by their labels
  user["fnumber"] = "5.6";
  user["transfer"] = "linear";
  MltImage result = source;
  host.filter(result, user, {kWidth, kHeight}, 3);
  const auto values = values_of({{"light-at", kLightAt}, {"fnumber", "5.6"}});
  CHECK(wrong_samples(result, source, library_flare(values, "tessar"), TransferCurve::Linear) == 0);
}

// MLT's previews are smaller than the profile, and its regions are then those of the preview.
TEST_CASE("openfx: MLT's previews show the whole picture's flare") {
  MltImage source = grey_picture(kWidth, kHeight), result = source;
  MltHost().filter(result, light_of_user(), {2 * kWidth, 2 * kHeight}, 3);
  const TestHost standard;
  Scene scene(standard, context::kGenerator, kBounds, 2 * kWidth, 2 * kHeight);
  scene.effect().scale = 0.5;
  REQUIRE(scene.render({.window = kBounds, .scale = 0.5}) == status::kOk);
  Image flare(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) flare.at(x, y, c) = scene.output.at(x, kHeight - 1 - y, c);
  REQUIRE(*std::ranges::max_element(flare.pixels) > 0.005F);
  CHECK(wrong_samples(result, source, flare, TransferCurve::Linear) == 0);
}

TEST_CASE("openfx: MLT's frame threads, an instance for each frame (threads)") {
  const MltHost host;
  MltImage source = grey_picture(kWidth, kHeight), expected = source;
  host.filter(expected, light_of_user(), {kWidth, kHeight}, 0);
  std::atomic<int> differing = 0;
  std::vector<std::thread> threads;
  for (int k = 0; k < 3; ++k)
    threads.emplace_back([&, k] {
      for (int frame = 0; frame < 3; ++frame) {
        MltImage result = source;
        host.filter(result, light_of_user(), {kWidth, kHeight}, 3 * k + frame);
        if (result.samples != expected.samples) ++differing;
      }
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(differing == 0);
}

TEST_CASE("openfx: in MLT a wrong value passes the source through") {
  const MltHost host;
  const MltImage source = grey_picture(kWidth, kHeight);
  MltImage result = source;
  auto user = light_of_user();
  user["lensFile"] = "/nowhere/lens.toml";
  host.filter(result, user, {kWidth, kHeight}, 0);
  CHECK(result.samples == source.samples);
}

TEST_CASE("openfx: a Natron node adds the library's flare to its source, and is black without one") {
  const TestHost host(natron_options());
  HostPicture source = HostPicture::of(kBounds), output = HostPicture::of(kBounds);
  paint_street(source);
  {
    const NatronNode node(host, kWidth, kHeight, &source);
    CHECK(node.effect().param("transfer").numbers[0] == 0.0);  // linear
    node.effect().set_text("wavelengths", kWavelengths);
    node.effect().set("detect", {0.0});
    node.effect().set("light1On", {1.0});
    node.effect().set("light1Position", {kLightX, kLightY});
    REQUIRE(node.render(output, 1.0, 1.0) == status::kOk);
    Image expected(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < 3; ++c) expected.at(x, y, c) = source.at(x, kHeight - 1 - y, c);
    add_flare(expected, library_flare(values_of({{"light-at", kLightAt}}), "heliar"));
    CHECK(differing_samples(output, expected) == 0);
    // Clones on several threads, while the node lives.
    std::atomic<int> differing = 0;
    std::vector<std::thread> threads;
    for (int k = 0; k < 3; ++k)
      threads.emplace_back([&] {
        HostPicture own = HostPicture::of(kBounds);
        if (node.render(own, 1.0, 1.0) != status::kOk || own.memory != output.memory) ++differing;
      });
    for (std::thread& thread : threads) thread.join();
    CHECK(differing == 0);
  }
  const NatronNode alone(host, kWidth, kHeight, nullptr);
  const RectD region = alone.region(1.0);
  CHECK(region.x2 - region.x1 == kWidth);
  CHECK(region.y2 - region.y1 == kHeight);
  REQUIRE(alone.render(output, 1.0, 1.0) == status::kOk);
  CHECK(sum_of(output) == 0.0);
}

TEST_CASE("openfx: Natron's preview scales, images that begin below zero, and a stop of the render thread") {
  const TestHost host(natron_options());
  HostPicture source = HostPicture::of({-16, -8, 48, 40}), output = HostPicture::of({-16, -8, 64, 48});
  paint_street(source);
  const NatronNode node(host, kWidth, kHeight, &source);
  node.effect().set_text("wavelengths", kWavelengths);
  const RectD region = node.region(1.0);
  CHECK(region.x1 == -16.0);
  CHECK(region.y2 == 48.0);
  REQUIRE(node.render(output, 1.0, 1.0) == status::kOk);
  const double whole = sum_of(output) - sum_of(source);
  CHECK(whole > 0.0);
  HostPicture half_source = HostPicture::of({-8, -4, 24, 20}), half_output = HostPicture::of({-8, -4, 32, 24});
  for (int y = -4; y < 20; ++y)
    for (int x = -8; x < 24; ++x)
      for (int c = 0; c < 4; ++c) {
        float sum = 0.0F;
        for (int k = 0; k < 4; ++k) sum += source.at(2 * x + k % 2, 2 * y + k / 2, c);
        half_source.set(x, y, c, sum / 4.0F);
      }
  const NatronNode small(host, kWidth, kHeight, &half_source);
  small.effect().set_text("wavelengths", kWavelengths);
  REQUIRE(small.render(half_output, 1.0, 0.5) == status::kOk);
  CHECK(4.0 * (sum_of(half_output) - sum_of(half_source)) == test::approx(whole).epsilon(0.1));
  CHECK(node.render(output, 2.0, 1.0, true) == status::kOk);
}
