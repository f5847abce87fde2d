// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "contrejour/expert/dirt.h"

namespace contrejour {

Result<std::shared_ptr<const DirtPicture>> DirtPicture::from_levels(std::span<const float> level, int width,
                                                                    int height) {
  if (width < 1 || height < 1 || level.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return failure(ErrorCode::InvalidArgument, "the picture of the dirt has no pixels");
  for (std::size_t k = 0; k < level.size(); ++k) {
    const float v = level[k];
    if (!(v >= 0.0F) || !std::isfinite(v))
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("the picture of the dirt has the value {} at {},{}; transmittances are 0 and more", v,
                                 k % static_cast<std::size_t>(width), k / static_cast<std::size_t>(width)));
  }
  auto picture = std::make_shared<DirtPicture>();
  picture->width_ = width;
  picture->height_ = height;
  picture->longer_ = std::max(width, height);
  picture->level_.assign(level.begin(), level.end());
  for (float& v : picture->level_) v = std::min(v, 1.0F);
  return std::shared_ptr<const DirtPicture>(std::move(picture));
}

double DirtPicture::transmission(Vec2 point) const {
  // In pixels from the top left; a ring of clean pixels surrounds the picture.
  const double x = 0.5 * (point.x * longer_ + width_) - 0.5;
  const double y = 0.5 * (-point.y * longer_ + height_) - 0.5;
  if (!(x > -1.0 && y > -1.0 && x < width_ && y < height_)) return 1.0;
  const double left = std::floor(x), top = std::floor(y);
  const auto level_at = [&](double column, double row) {
    if (column < 0.0 || row < 0.0 || column >= width_ || row >= height_) return 1.0;
    return static_cast<double>(
        level_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)]);
  };
  const double s = x - left, t = y - top;
  return (1.0 - t) * ((1.0 - s) * level_at(left, top) + s * level_at(left + 1.0, top)) +
         t * ((1.0 - s) * level_at(left, top + 1.0) + s * level_at(left + 1.0, top + 1.0));
}

}  // namespace contrejour
