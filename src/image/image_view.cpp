// SPDX-License-Identifier: Apache-2.0
#include "contrejour/image_view.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include <fmt/format.h>
#include <half.h>

#include "base/tasks.h"
#include "image/pixel_writer.h"

namespace contrejour {
namespace {

constexpr int kRowsOfTask = 32;
constexpr std::size_t kChannels = 3;

std::ptrdiff_t bytes_of(PixelType type) {
  return type == PixelType::Half ? std::ptrdiff_t{sizeof(std::uint16_t)} : std::ptrdiff_t{sizeof(float)};
}

// NaN stays NaN.
std::uint16_t nearest_half(float value) {
  constexpr float kLargest = 65504.0F;  // HALF_MAX
  return half(std::clamp(value, -kLargest, kLargest)).bits();
}

template <class Sample>
void put(Sample sample, std::byte* to) {
  std::memcpy(to, &sample, sizeof(Sample));
}

template <class Convert>
void write_row(std::span<const float> row, std::byte* to, const ImageView& view, const Convert& convert) {
  for (std::size_t k = 0; k < row.size(); k += kChannels, to += view.pixel_step)
    for (std::size_t c = 0; c < kChannels; ++c)
      put(convert(row[k + c]), to + static_cast<std::ptrdiff_t>(c) * view.channel_step);
}

// Pixels that lie as an Image has them go past the caches.
bool is_packed(const ImageView& view) {
  constexpr std::ptrdiff_t kSample = sizeof(float);
  return view.type == PixelType::Float && view.channel_step == kSample && view.pixel_step == kSample * 3 &&
         reinterpret_cast<std::uintptr_t>(view.pixels) % alignof(float) == 0 && view.row_step % kSample == 0;
}

void write_row(std::span<const float> row, std::byte* to, const ImageView& view, const PixelWriter& packed) {
  if (is_packed(view))
    packed.write(row.data(), row.size(), reinterpret_cast<float*>(to));
  else if (view.type == PixelType::Half)
    write_row(row, to, view, nearest_half);
  else
    write_row(row, to, view, [](float value) { return value; });
}

}  // namespace

Result<void> check_view(const ImageView& view, int width, int height) {
  if (view.width != width || view.height != height)
    return invalid_argument(fmt::format("a picture of {} x {} pixels does not fit a view of {} x {}", width, height,
                                        view.width, view.height));
  if (view.pixels == nullptr && width > 0 && height > 0) return invalid_argument("a view without pixels");
  const std::ptrdiff_t sample = bytes_of(view.type);
  const auto too_small = [&](std::ptrdiff_t step) { return std::abs(step) < sample; };
  if (too_small(view.channel_step) || too_small(view.pixel_step) || (height > 1 && too_small(view.row_step)))
    return invalid_argument(fmt::format("a view's steps of {}, {} and {} bytes let samples of {} bytes overlap",
                                        view.channel_step, view.pixel_step, view.row_step, sample));
  return {};
}

ImageView view_of(Image& image) {
  constexpr std::ptrdiff_t kSample = sizeof(float);
  const std::ptrdiff_t pixel = image.channels * kSample;
  return {image.pixels.data(), image.width, image.height, PixelType::Float, kSample, pixel, image.width * pixel};
}

Result<void> write_pixels(const Image& image, const ImageView& to, const Context& context) {
  if (image.channels != static_cast<int>(kChannels))
    return invalid_argument(fmt::format("an image of {} channels cannot be written as RGB", image.channels));
  if (const auto good = check_view(to, image.width, image.height); !good) return good;
  auto* const pixels = static_cast<std::byte*>(to.pixels);
  const int tasks = (image.height + kRowsOfTask - 1) / kRowsOfTask;
  const bool done = parallel_for(static_cast<std::size_t>(tasks), context, [&](std::size_t task) {
    const PixelWriter packed(image);
    const int first = static_cast<int>(task) * kRowsOfTask, last = std::min(first + kRowsOfTask, image.height);
    for (int y = first; y < last; ++y) write_row(image.row(y), pixels + y * to.row_step, to, packed);
  });
  if (!done) return interrupted();
  return {};
}

}  // namespace contrejour
