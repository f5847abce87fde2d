// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/picture_window.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace contrejour {
namespace {

Result<void> check_window(const PixelWindow& window, int width, int height) {
  const bool fits = window.x >= 0 && window.y >= 0 && window.width > 0 && window.height > 0 &&
                    window.width <= width - window.x && window.height <= height - window.y;
  if (fits) return {};
  return invalid_argument(fmt::format(
      "a window of {} x {} pixels at ({}, {}) does not lie in the picture of {} x {}; give x, y, width and height in "
      "pixels from its top left corner",
      window.width, window.height, window.x, window.y, width, height));
}

}  // namespace

Image window_of(const Image& image, const PixelWindow& window) {
  assert(check_window(window, image.width, image.height));
  Image part = Image::unwritten(window.width, window.height, image.channels);
  const auto samples = part.row(0).size();
  for (int y = 0; y < window.height; ++y)
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(image.index(window.x, window.y + y)), samples,
                part.row(y).begin());
  return part;
}

Result<PictureRequest> window_of(PictureRequest request, const PixelWindow& window, const params::Values& values,
                                 const LensState& lens) {
  const PixelWindow whole{0, 0, request.grid.width, request.grid.height};
  if (auto good = check_window(window, whole.width, whole.height); !good) return tl::unexpected(good.error());
  const auto grid = pixel_grid(values, lens, window, whole, request.pixel_aspect);
  if (!grid) return tl::unexpected(grid.error());
  request.grid = *grid;
  request.settings.frame = grid->frame;
  return request;
}

Result<FlarePlan> window_of(FlarePlan plan, const PixelWindow& window, const Picture& picture,
                            const params::Values& values, const LensState& lens) {
  if (auto good = check_window(window, plan.grid.width, plan.grid.height); !good) return tl::unexpected(good.error());
  const PixelWindow data{picture.data_window.x + window.x, picture.data_window.y + window.y, window.width,
                         window.height};
  const auto grid = pixel_grid(values, lens, data, picture.display_window, plan.pixel_aspect);
  if (!grid) return tl::unexpected(grid.error());
  if (plan.light_matte) {
    const Frame &part = grid->frame, &all = plan.grid.frame;
    const PixelWindow in_frame{part.origin_x - all.origin_x, part.origin_y - all.origin_y, part.width, part.height};
    plan.light_matte = std::make_shared<const Image>(window_of(*plan.light_matte, in_frame));
  }
  plan.grid = *grid;
  return plan;
}

}  // namespace contrejour
