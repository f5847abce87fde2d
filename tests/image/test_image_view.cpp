// SPDX-License-Identifier: Apache-2.0
// A caller's pixels: types, strides, refused input.
#include "contrejour/image_view.h"

#include <cstring>
#include <limits>
#include <vector>

#include <doctest/doctest.h>
#include <half.h>

using namespace contrejour;

namespace {

Image ramp(int width, int height) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) image.pixels[k] = 0.1F * static_cast<float>(k) - 1.0F;
  return image;
}

}  // namespace

TEST_CASE("an image written to an image is that image") {
  const Image from = ramp(70, 50);
  Image to(70, 50);
  REQUIRE(write_pixels(from, view_of(to)).has_value());
  CHECK(to.pixels == from.pixels);
}

TEST_CASE("planes of floats at odd addresses") {
  const Image from = ramp(5, 3);
  constexpr std::ptrdiff_t kSample = sizeof(float);
  std::vector<std::byte> bytes(1 + from.pixels.size() * sizeof(float));
  const ImageView planes{bytes.data() + 1, 5, 3, PixelType::Float, 15 * kSample, kSample, 5 * kSample};
  REQUIRE(write_pixels(from, planes).has_value());
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x)
      for (int c = 0; c < 3; ++c) {
        float value = 0.0F;
        std::memcpy(&value, bytes.data() + 1 + kSample * (15 * c + 5 * y + x), sizeof value);
        CHECK(value == from.at(x, y, c));
      }
}

TEST_CASE("half floats: the nearest, the largest, and no number") {
  Image from(2, 1);
  from.pixels[0] = 1e9F;
  from.pixels[1] = -std::numeric_limits<float>::infinity();
  from.pixels[2] = std::numeric_limits<float>::quiet_NaN();
  from.pixels[3] = 0.1F;
  std::vector<half> to(6);
  constexpr std::ptrdiff_t kSample = sizeof(half);
  REQUIRE(write_pixels(from, {to.data(), 2, 1, PixelType::Half, kSample, 3 * kSample, 6 * kSample}).has_value());
  CHECK(to[0] == half(65504.0F));
  CHECK(to[1] == half(-65504.0F));
  CHECK(to[2].isNan());
  CHECK(to[3] == half(0.1F));
}

TEST_CASE("views that cannot hold an image are refused") {
  Image image = ramp(4, 4);
  ImageView view = view_of(image);
  view.width = 5;
  CHECK_FALSE(write_pixels(image, view).has_value());
  view = view_of(image);
  view.pixel_step = 0;
  CHECK_FALSE(write_pixels(image, view).has_value());
  view = view_of(image);
  view.row_step = 2;
  CHECK_FALSE(write_pixels(image, view).has_value());
  view = view_of(image);
  view.pixels = nullptr;
  CHECK_FALSE(write_pixels(image, view).has_value());
  CHECK_FALSE(write_pixels(Image(4, 4, 1), view_of(image)).has_value());
}
