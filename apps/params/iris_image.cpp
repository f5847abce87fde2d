#include "params/iris_image.h"

#include <vector>

#include "contrejour/image_io.h"

namespace contrejour::params {
namespace {

constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26U;  // 8192 x 8192; 1024 across are kept

}  // namespace

Result<std::shared_ptr<const IrisField>> read_iris_image(const std::string& file) {
  ReadOptions options;
  options.limits.max_pixels = kMostPixels;
  const auto picture = read_picture(file, options);
  if (!picture) return tl::unexpected(picture.error());
  const Image& rgb = picture->rgb;
  std::vector<float> level;
  level.reserve(rgb.pixels.size() / 3);
  for (std::size_t k = 0; k + 2 < rgb.pixels.size(); k += 3)
    level.push_back((rgb.pixels[k] + rgb.pixels[k + 1] + rgb.pixels[k + 2]) / 3.0F);
  auto field = IrisField::from_levels(level, rgb.width, rgb.height);
  if (!field) field.error().place.file = file;
  return field;
}

}  // namespace contrejour::params
