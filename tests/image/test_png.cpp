// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstring>

#include "contrejour/expert/metrics.h"
#include "support/approx.h"
#include "test_pictures.h"

using namespace contrejour;
using namespace contrejour::test;

namespace {

// Every 16-bit code once in each channel, with decreasing alpha; or every 8-bit one.
Picture all_codes(SampleType type, bool with_alpha) {
  const int side = type == SampleType::UInt8 ? 16 : 256;
  const auto count = static_cast<std::size_t>(side * side);
  Picture picture = picture_of(Image(side, side, 3));
  picture.channels.clear();
  picture.rgb_source = {0, 1, 2};
  for (const char* name : {"R", "G", "B", "A"}) {
    if (*name == 'A' && !with_alpha) continue;
    PictureChannel c{name, type, 1, 1, false, std::vector<std::byte>(count * size_of(type))};
    for (std::size_t i = 0; i < count; ++i) {
      const auto code =
          static_cast<std::uint16_t>(*name == 'A' ? count - 1 - i / 2 : (*name == 'G' ? count - 1 - i : i));
      std::memcpy(c.samples.data() + i * size_of(type), &code, size_of(type));
    }
    picture.channels.push_back(std::move(c));
  }
  return picture;
}

// The values that a reader returns for these codes, so that writing preserves them.
Picture with_values(Picture picture) {
  const double largest = picture.channels[0].type == SampleType::UInt8 ? 255 : 65535;
  const auto code = [&](std::size_t c, std::size_t i) {
    std::uint16_t value = 0;
    std::memcpy(&value, picture.channels[c].samples.data() + i * size_of(picture.channels[c].type),
                size_of(picture.channels[c].type));
    return value / largest;
  };
  for (std::size_t i = 0; i < picture.rgb.pixels.size() / 3; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const double v = code(c, i);
      const double linear = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);  // IEC 61966-2-1
      const double alpha = picture.channels.size() > 3 ? code(3, i) : 1;
      picture.rgb.pixels[3 * i + c] = static_cast<float>(linear * alpha);
    }
  return picture;
}

}  // namespace

TEST_CASE("every 8 and 16 bit code goes to linear and back") {
  for (const SampleType type : {SampleType::UInt8, SampleType::UInt16})
    for (const bool with_alpha : {false, true}) {
      CAPTURE(with_alpha);
      const ScratchFolder folder;
      const Picture given = with_values(all_codes(type, with_alpha));
      must_write(folder / "a.png", given);
      const Picture read = must_read(folder / "a.png");
      if (!with_alpha) check_same_channels(given, read);
      double worst = 0;
      for (std::size_t i = 0; i < read.rgb.pixels.size(); ++i)
        worst = std::max<double>(worst, std::abs(read.rgb.pixels[i] - given.rgb.pixels[i]));
      CHECK(worst < 1e-6);
      must_write(folder / "b.png", read);
      check_same_channels(read, must_read(folder / "b.png"));
    }
}

TEST_CASE("a changed PNG pixel is coded as sRGB and clipped") {
  const ScratchFolder folder;
  must_write(folder / "a.png", with_values(all_codes(SampleType::UInt8, false)));
  Picture picture = must_read(folder / "a.png");
  picture.rgb.at(4, 4, 0) = 0.5F;
  picture.rgb.at(5, 4, 0) = 7;
  picture.rgb.at(6, 4, 0) = -1;
  picture.rgb.at(7, 4, 0) = std::nanf("");
  must_write(folder / "b.png", picture);
  const Picture back = must_read(folder / "b.png");
  CHECK(channel(back, "R").samples[4 * 16 + 4] == std::byte{188});  // sRGB of 0.5
  CHECK(channel(back, "R").samples[4 * 16 + 5] == std::byte{255});
  CHECK(channel(back, "R").samples[4 * 16 + 6] == std::byte{0});
  CHECK(channel(back, "R").samples[4 * 16 + 7] == std::byte{0});
  CHECK(channel(back, "G").samples == channel(picture, "G").samples);
}

TEST_CASE("light that is added where a picture is transparent is in its PNG") {
  for (const SampleType type : {SampleType::UInt8, SampleType::UInt16}) {
    const ScratchFolder folder;
    must_write(folder / "a.png", with_values(all_codes(type, true)));
    const Picture before = must_read(folder / "a.png");
    const int side = before.rgb.width;
    Picture lit = before;
    for (int y = 1; y < side; y += 2)  // alpha decreases from opaque to transparent
      for (int x = 0; x < side; ++x)
        for (int c = 0; c < 3; ++c) lit.rgb.at(x, y, c) += 0.05F * static_cast<float>((c + 1) * (x + 1)) / side;
    must_write(folder / "b.png", lit);
    const Picture back = must_read(folder / "b.png");
    const std::size_t size = size_of(type);
    // The size of a code's step: for a colour the steepest of sRGB's, and for alpha.
    const double step = type == SampleType::UInt8 ? 1.2 / 255 : 1.2 / 65535;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const auto pixel = static_cast<std::size_t>(y * side + x);
        if (y % 2 == 0) {
          for (const char* name : {"R", "G", "B", "A"})
            REQUIRE(std::memcmp(channel(back, name).samples.data() + pixel * size,
                                channel(before, name).samples.data() + pixel * size, size) == 0);
          continue;
        }
        for (int c = 0; c < 3; ++c)
          REQUIRE(std::abs(back.rgb.at(x, y, c) - std::min(lit.rgb.at(x, y, c), 1.0F)) < step);
      }
  }
  // A light before an empty background, from an OpenEXR file's alpha.
  const ScratchFolder folder;
  Image image(3, 1, 4);
  image.pixels = {0.5F, 0.25F, 0, 0, 3, 1, 0, 0.5F, 0.25F, 0.25F, 0.25F, 0.5F};
  must_write(folder / "a.exr", picture_of(image));
  must_write(folder / "a.png", must_read(folder / "a.exr"));
  const Picture png = must_read(folder / "a.png");
  const std::vector<float> seen{0.5F, 0.25F, 0, 1, 1, 0, 0.25F, 0.25F, 0.25F};
  for (std::size_t k = 0; k < seen.size(); ++k) CHECK(png.rgb.pixels[k] == test::approx(seen[k]).epsilon(1e-4));
  std::uint16_t alpha[3];
  std::memcpy(alpha, channel(png, "A").samples.data(), sizeof alpha);
  CHECK(alpha[0] == 32768);
  CHECK(alpha[1] == 65535);
  CHECK(alpha[2] == 32768);
}

TEST_CASE("between PNG and OpenEXR the light stays") {
  const ScratchFolder folder;
  must_write(folder / "a.png", with_values(all_codes(SampleType::UInt16, true)));
  const Picture png = must_read(folder / "a.png");
  must_write(folder / "a.exr", png);
  const Picture exr = must_read(folder / "a.exr");
  CHECK(channel(exr, "A").type == SampleType::Float);
  CHECK(exr.rgb.pixels == png.rgb.pixels);
  must_write(folder / "b.png", exr);
  const Picture back = must_read(folder / "b.png");
  double worst = 0;
  for (std::size_t i = 0; i < png.rgb.pixels.size(); ++i)
    worst = std::max<double>(worst, std::abs(back.rgb.pixels[i] - png.rgb.pixels[i]));
  CHECK(worst < 4e-5);  // a 16-bit code's step at white
}

TEST_CASE("previews: exposure and roll-off") {
  const ScratchFolder folder;
  Image image(4, 1, 3);
  for (int c = 0; c < 3; ++c) {
    image.at(0, 0, c) = 0.25F;
    image.at(1, 0, c) = 0.8F;
    image.at(2, 0, c) = 3;
    image.at(3, 0, c) = std::nanf("");
  }
  const auto code = [&](const PreviewSettings& settings, std::size_t x) {
    REQUIRE(write_preview_png(folder / "p.png", image, settings).has_value());
    return std::to_integer<int>(channel(must_read(folder / "p.png"), "R").samples[x]);
  };
  CHECK(code({0, false}, 0) == 137);  // sRGB of 0.25
  CHECK(code({1, false}, 0) == 188);  // of 0.5
  CHECK(code({0, false}, 2) == 255);
  CHECK(code({0, true}, 0) == 137);
  CHECK(code({0, true}, 1) == code({0, false}, 1));
  CHECK(code({-1, true}, 2) < 255);
  CHECK(code({-1, true}, 2) > code({0, true}, 1));
  CHECK(code({0, true}, 3) == 0);
}
