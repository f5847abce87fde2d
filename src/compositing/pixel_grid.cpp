// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/pixel_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/settings.h"

namespace contrejour {
namespace {

constexpr double kSquareTolerance = 1e-4;  // a smaller difference of an aspect ratio from 1 is rounding in a file

// The frame's pixels and the picture's, along a row or a column.
struct Axis {
  int picture = 0;  // number of the picture's pixels
  double corner = 0, per_pixel = 1;  // as in PixelGrid

  // Calls visit(pixel of the picture, fraction of the frame's pixel that lies in it).
  template <class Visit>
  void for_each_part(int k, const Visit& visit) const {
    const double low = (k - corner) / per_pixel, high = (k + 1 - corner) / per_pixel;
    const int first = std::max(0, static_cast<int>(std::floor(low)));
    for (int p = first; p < picture && p < high; ++p) {
      const double fraction = (std::min(high, p + 1.0) - std::max(low, static_cast<double>(p))) * per_pixel;
      if (fraction > 0.0) visit(p, static_cast<float>(fraction));
    }
  }
};

// Calls visit(x, y, column, row, fraction): the fraction of the frame's pixel (x, y) that lies in the picture's
// (column, row).
template <class Visit>
void for_each_part(const PixelGrid& grid, const Visit& visit) {
  const Axis across{grid.width, grid.corner_px.x, grid.per_pixel.x};
  const Axis down{grid.height, grid.corner_px.y, grid.per_pixel.y};
  for (int y = 0; y < grid.frame.height; ++y) {
    down.for_each_part(y, [&](int row, float row_fraction) {
      for (int x = 0; x < grid.frame.width; ++x)
        across.for_each_part(x, [&](int column, float fraction) { visit(x, y, column, row, row_fraction * fraction); });
    });
  }
}

// One side of the rendered frame: it has `length` pixels and begins at pixel `origin` of a whole frame of `full`
// pixels. The picture begins at `corner` within it.
struct FrameSide {
  int origin = 0, length = 0, full = 0;
  double corner = 0;
};

// The data window has `count` pixels from `first`, in a display window of `whole` pixels.
FrameSide frame_side(int first, int count, int whole, double per_pixel) {
  FrameSide side;
  side.full = static_cast<int>(std::ceil(whole * per_pixel));
  const double begin = (first - 0.5 * whole) * per_pixel + 0.5 * side.full;
  side.origin = static_cast<int>(std::floor(begin));
  side.length = static_cast<int>(std::ceil(begin + count * per_pixel)) - side.origin;
  side.corner = begin - side.origin;
  return side;
}

}  // namespace

double squeeze_of(const LensState& lens) {
  if (lens.has_axial_symmetry()) return 1.0;
  const FirstOrder figures = first_order(lens, lens.design_wavelength_nm);
  const double squeeze = std::abs(figures.focal_length_mm / figures.focal_length_x_mm);
  return std::isfinite(squeeze) && std::abs(squeeze - 1.0) > kSquareTolerance ? squeeze : 1.0;
}

Result<PixelGrid> pixel_grid(const params::Values& values, const LensState& lens, const PixelWindow& data,
                             const PixelWindow& display, double pixel_aspect) {
  if (display.width < 1 || display.height < 1 || data.width < 1 || data.height < 1)
    return invalid_argument(
        "the data window or the display window has no pixels, so that the optical axis has no position; give a picture "
        "with pixels");
  PixelGrid grid;
  grid.width = data.width;
  grid.height = data.height;
  const double aspect = pixel_aspect / squeeze_of(lens);  // that of a pixel on the sensor
  const bool is_square = std::abs(aspect - 1.0) <= kSquareTolerance;
  if (!is_square) grid.per_pixel = {std::max(1.0, aspect), std::max(1.0, 1.0 / aspect)};
  const double square_pixels = grid.per_pixel.x * grid.per_pixel.y;
  if (square_pixels *
          std::max(static_cast<double>(display.width) * display.height, static_cast<double>(data.width) * data.height) >
      params::kMaxPixels)
    return invalid_argument("the picture covers more than 2^28 square pixels; give a smaller picture");

  Frame& frame = grid.frame;
  const FrameSide across = frame_side(data.x - display.x, data.width, display.width, grid.per_pixel.x);
  const FrameSide down = frame_side(data.y - display.y, data.height, display.height, grid.per_pixel.y);
  frame.origin_x = across.origin;
  frame.origin_y = down.origin;
  frame.width = across.length;
  frame.height = down.length;
  frame.full_width = across.full;
  frame.full_height = down.full;
  grid.corner_px = {across.corner, down.corner};
  frame.pixel_pitch_mm =
      params::pixel_pitch_mm(values, lens, {display.width * grid.per_pixel.x, display.height * grid.per_pixel.y});
  return grid;
}

Image picture_of_frame(const Image& frame, const PixelGrid& grid) {
  if (grid.is_square()) return frame;
  Image picture(grid.width, grid.height, frame.channels);
  for_each_part(grid, [&](int x, int y, int column, int row, float fraction) {
    for (int c = 0; c < frame.channels; ++c) picture.at(column, row, c) += fraction * frame.at(x, y, c);
  });
  return picture;
}

Result<Image> picture_of_flare(Image frame, const PixelGrid& grid) {
  Image picture = grid.is_square() ? std::move(frame) : picture_of_frame(frame, grid);
  const auto not_finite = std::ranges::count_if(picture.pixels, [](float value) { return !std::isfinite(value); });
  if (not_finite == 0) return picture;
  return invalid_argument(fmt::format(
      "{} samples of the flare are not finite numbers; give the lights smaller values and gains, and please "
      "report this error",
      not_finite));
}

Image frame_of_picture(const Image& picture, const PixelGrid& grid) {
  if (grid.is_square()) return picture;
  Image frame(grid.frame.width, grid.frame.height, picture.channels);
  for_each_part(grid, [&](int x, int y, int column, int row, float fraction) {
    for (int c = 0; c < frame.channels; ++c) frame.at(x, y, c) += fraction * picture.at(column, row, c);
  });
  return frame;
}

}  // namespace contrejour
