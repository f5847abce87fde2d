// SPDX-License-Identifier: Apache-2.0
// Views of OpenColorIO: codes by hand, and what cannot be shown.
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "studio/core/view.h"
#include "studio/core/view_codes.h"
#include "studio/core/views_job.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

Image one_pixel(float r, float g, float b) {
  Image image(1, 1);
  image.pixels = {r, g, b};
  return image;
}

std::array<int, 3> code_of(const std::vector<std::uint32_t>& rgba) {
  REQUIRE(rgba.size() == 1);
  return {static_cast<int>(rgba[0] & 255U), static_cast<int>(rgba[0] >> 8U & 255U),
          static_cast<int>(rgba[0] >> 16U & 255U)};
}

// IEC 61966-2-1
int srgb_code(double v) { return static_cast<int>(std::lround(255 * (1.055 * std::pow(v, 1 / 2.4) - 0.055))); }

bool has_module(const Result<std::vector<ColourDisplay>>& displays) {
  if (displays || displays.error().code != ErrorCode::Unsupported) return true;
  MESSAGE("skipped: built without OpenColorIO");
  return false;
}

TEST_CASE("the built-in displays have a view without tone mapping, and that of ACES") {
  const auto displays = colour_displays("");
  if (!has_module(displays)) return;
  REQUIRE(displays);
  REQUIRE(displays->size() == 3);
  CHECK(displays->front().name == "sRGB");
  CHECK(displays->front().views == std::vector<std::string>{"ACES SDR video", "Un-tone-mapped"});
  ViewPainter painter;
  const auto codes = [&](const Image& image, ColourSpace space, double stops, const char* view) {
    const auto shown = painter.codes(image, space, stops, ViewTransform::Colour, {"sRGB", view});
    CHECK(shown.error == "");
    return code_of(shown.rgba);
  };
  const auto plain = codes(one_pixel(0.1F, 0.2F, 0.05F), ColourSpace::Rec709, 1, "Un-tone-mapped");
  CHECK(plain[0] == test::approx(srgb_code(0.2)).epsilon(0.01));
  CHECK(plain[1] == test::approx(srgb_code(0.4)).epsilon(0.01));
  CHECK(plain[2] == test::approx(srgb_code(0.1)).epsilon(0.01));
  // ACES 1 maps a scene's 18 per cent to 4.8 of 48 cd/m2; its video output then raises the luminance to 0.9811 for
  // dim surroundings (ODT.Academy.RGBmonitor_D65_100nits_dim, DIM_SURROUND_GAMMA).
  for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg}) {
    const auto grey = codes(one_pixel(0.18F, 0.18F, 0.18F), space, 0, "ACES SDR video");
    for (const int code : grey) CHECK(code == test::approx(srgb_code(std::pow(0.1, 0.9811))).epsilon(0.012));
  }
  const auto bright = codes(one_pixel(1e6F, 1e6F, 1e6F), ColourSpace::Rec709, 0, "Un-tone-mapped");
  CHECK(bright == std::array{255, 255, 255});
}

TEST_CASE("a view that the configuration has not is a preview, with the reason") {
  if (!has_module(colour_displays(""))) return;
  ViewPainter painter;
  const Image grey = one_pixel(0.3F, 0.3F, 0.3F);
  const auto shown = painter.codes(grey, ColourSpace::Rec709, 0, ViewTransform::Colour, {"sRGB", "Nonesuch"});
  CHECK(shown.error.find("Nonesuch") != std::string::npos);
  CHECK(shown.rgba == displayed(grey, 0, ViewTransform::Preview));
  const auto missing = colour_displays("/no/such/config.ocio");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().position.file == "/no/such/config.ocio");
}

// Colours of all brightnesses from 2^-10 to 2^12: greys, mild ones and the purest of the space.
Image colours_of_all_kinds() {
  Image image(64, 96);
  std::uint32_t random = 7;
  const auto next = [&] { return static_cast<float>((random = random * 1664525U + 1013904223U) >> 8U) / 16777216.0F; };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float level = std::exp2(22 * next() - 10), purity = static_cast<float>(y / 32) * 0.5F;
      for (int c = 0; c < 3; ++c)
        image.pixels[static_cast<std::size_t>(3 * (y * image.width + x) + c)] =
            level * (1 - purity + purity * next() * next());
    }
  return image;
}

TEST_CASE("the table of a view has its codes to 3 of 255") {
  if (!has_module(colour_displays(""))) return;
  const Image image = colours_of_all_kinds();
  for (const char* name : {"ACES SDR video", "Un-tone-mapped"})
    for (const ColourSpace space : {ColourSpace::Rec709, ColourSpace::AcesCg}) {
      CAPTURE(name);
      const auto view = ColourView::open("", {"sRGB", name});
      REQUIRE(view);
      std::vector<float> exact(image.pixels.begin(), image.pixels.end());
      REQUIRE(view->apply(exact, space));
      ViewPainter painter;
      const auto shown = painter.codes(image, space, 0, ViewTransform::Colour, {"sRGB", name});
      double largest = 0, sum = 0;
      for (std::size_t k = 0; k < exact.size(); ++k) {
        const double code = 255 * std::fmin(std::fmax(static_cast<double>(exact[k]), 0.0), 1.0);
        const double apart = std::abs((shown.rgba[k / 3] >> 8U * (k % 3) & 255U) - code);
        largest = std::fmax(largest, apart);
        sum += apart;
      }
      CHECK(largest < 3);
      CHECK(sum / static_cast<double>(exact.size()) < 0.2);  // rounding alone is 0.25 where no code is clipped
    }
}

TEST_CASE("pictures in ACEScg are shown in the window's primaries") {
  ViewPainter painter;
  const auto shown = painter.codes(one_pixel(0.2F, 0.2F, 0.2F), ColourSpace::AcesCg, 0, ViewTransform::Clipped, {});
  for (const int code : code_of(shown.rgba)) CHECK(code == test::approx(srgb_code(0.2)).epsilon(0.01));
  const auto green = painter.codes(one_pixel(0, 0.2F, 0), ColourSpace::AcesCg, 0, ViewTransform::Clipped, {});
  CHECK(code_of(green.rgba)[1] > srgb_code(0.2));
  CHECK(code_of(green.rgba)[0] == 0);
}

TEST_CASE("the view is saved by its names") {
  View view;
  view.transform = ViewTransform::Colour;
  view.colour = {"P3 D65", "ACES SDR cinema"};
  const View read = view_of_json(json_of_view(view));
  CHECK(read.transform == ViewTransform::Colour);
  CHECK(read.colour == view.colour);
  CHECK(view_of_json(R"({"transform": 3, "colour-view": [1, 2]})").colour == ColourViewName{});
}

}  // namespace
}  // namespace contrejour::studio
