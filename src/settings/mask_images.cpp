// SPDX-License-Identifier: Apache-2.0
#include "settings/mask_images.h"

#include <span>
#include <vector>

#include "contrejour/image_io.h"

namespace contrejour::params {
namespace {

constexpr std::uint64_t kMaxMaskPixels = std::uint64_t{1} << 26U;  // 8192 x 8192

// `make` builds the value from levels, width and height.
template <class Value>
Result<Value> read_levels(const std::string& file, Result<Value> (*make)(std::span<const float>, int, int)) {
  ReadOptions options;
  options.limits.max_pixels = kMaxMaskPixels;
  const auto picture = read_picture(file, options);
  if (!picture) return tl::unexpected(picture.error());
  const Image& rgb = picture->rgb;
  std::vector<float> level;
  level.reserve(rgb.pixels.size() / 3);
  for (std::size_t k = 0; k + 2 < rgb.pixels.size(); k += 3)
    level.push_back((rgb.pixels[k] + rgb.pixels[k + 1] + rgb.pixels[k + 2]) / 3.0F);
  auto value = make(level, rgb.width, rgb.height);
  if (!value) value.error().position.file = file;
  return value;
}

}  // namespace

Result<std::shared_ptr<const IrisField>> read_iris_image(const std::string& file) {
  return read_levels(file, IrisField::from_levels);
}

Result<std::shared_ptr<const DirtPicture>> read_dirt_image(const std::string& file) {
  return read_levels(file, DirtPicture::from_levels);
}

}  // namespace contrejour::params
