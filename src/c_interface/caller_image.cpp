// SPDX-License-Identifier: Apache-2.0
#include "c_interface/caller_image.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>
#include <half.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::inline internal {
namespace {

constexpr std::ptrdiff_t kChannelsOfCaller = 3;

std::byte* sample_at(const ImageView& view, int x, int y, int c) {
  return static_cast<std::byte*>(view.pixels) + y * view.row_step + x * view.pixel_step + c * view.channel_step;
}

float read_sample(const ImageView& view, const std::byte* at) {
  if (view.type == PixelType::Half) {
    half value;
    std::uint16_t bits = 0;
    std::memcpy(&bits, at, sizeof(bits));
    value.setBits(bits);
    return value;
  }
  float value = 0.0F;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

void write_sample(const ImageView& view, float value, std::byte* at) {
  if (view.type == PixelType::Half) {
    constexpr float kLargest = 65504.0F;  // HALF_MAX
    const std::uint16_t bits = half(std::clamp(value, -kLargest, kLargest)).bits();
    std::memcpy(at, &bits, sizeof(bits));
    return;
  }
  std::memcpy(at, &value, sizeof(value));
}

template <class Visit>
void for_each_sample(const ImageView& view, const Visit& visit) {
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x)
      for (int c = 0; c < kChannelsOfCaller; ++c) visit(x, y, c, sample_at(view, x, y, c));
}

}  // namespace

Result<ImageView> view_of(const cj_image* image) {
  if (const auto good = check_struct(image, sizeof(cj_image), "cj_image"); !good) return tl::unexpected(good.error());
  if (image->width < 1 || image->height < 1 || static_cast<double>(image->width) * image->height > params::kMaxPixels)
    return invalid_argument(
        fmt::format("an image of {} x {} pixels; give 1 x 1 to 2^28 pixels in all", image->width, image->height));
  if (image->sample != CJ_FLOAT && image->sample != CJ_HALF)
    return invalid_argument(fmt::format("{} is not a type of sample; give CJ_FLOAT or CJ_HALF", image->sample));
  ImageView view;
  view.pixels = image->pixels;
  view.width = image->width;
  view.height = image->height;
  view.type = image->sample == CJ_HALF ? PixelType::Half : PixelType::Float;
  const std::ptrdiff_t sample_bytes = view.type == PixelType::Half ? 2 : 4;
  view.channel_step = image->channel_step != 0 ? image->channel_step : sample_bytes;
  view.pixel_step = image->pixel_step != 0 ? image->pixel_step : kChannelsOfCaller * sample_bytes;
  view.row_step = image->row_step != 0 ? image->row_step : view.width * view.pixel_step;
  if (const auto good = check_view(view, view.width, view.height); !good) return tl::unexpected(good.error());
  return view;
}

Image read_pixels(const ImageView& view) {
  Image image = Image::unwritten(view.width, view.height);
  for_each_sample(view, [&](int x, int y, int c, const std::byte* at) { image.at(x, y, c) = read_sample(view, at); });
  return image;
}

void write_changes(const Image& before, const Image& to, const ImageView& view) {
  for_each_sample(view, [&](int x, int y, int c, std::byte* at) {
    const std::size_t k = to.index(x, y, c);
    if (std::memcmp(&before.pixels[k], &to.pixels[k], sizeof(float)) != 0) write_sample(view, to.pixels[k], at);
  });
}

}  // namespace contrejour::inline internal
