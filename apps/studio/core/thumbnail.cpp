// SPDX-License-Identifier: Apache-2.0
#include "studio/core/thumbnail.h"

#include <algorithm>

namespace contrejour::studio {

Thumbnail reduced_codes(std::span<const std::uint32_t> rgba, int width, int height) {
  if (width < 1 || height < 1 || rgba.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    return {};
  const double factor =
      std::max({1.0, static_cast<double>(width) / kThumbnailWidth, static_cast<double>(height) / kThumbnailHeight});
  Thumbnail small{std::max(1, static_cast<int>(width / factor)), std::max(1, static_cast<int>(height / factor)), {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int sx = std::min(width - 1, static_cast<int>((x + 0.5) * factor)),
                sy = std::min(height - 1, static_cast<int>((y + 0.5) * factor));
      small.rgba.push_back(
          rgba[static_cast<std::size_t>(sy) * static_cast<std::size_t>(width) + static_cast<std::size_t>(sx)]);
    }
  return small;
}

}  // namespace contrejour::studio
