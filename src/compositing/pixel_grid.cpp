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

constexpr double kSquare = 1e-4;  // an aspect this close to 1 is due to rounding in a file

// The positions of the frame's pixels among those of the picture, along a row or a column.
struct Axis {
  int picture = 0;  // pixels of the picture
  double corner = 0, per_pixel = 1;

  // Calls visit(pixel of the picture, fraction of the frame's pixel that lies in it).
  template <class Visit>
  void for_each_part(int k, const Visit& visit) const {
    const double low = (k - corner) / per_pixel, high = (k + 1 - corner) / per_pixel;
    const int first = std::max(0, static_cast<int>(std::floor(low)));
    for (int p = first; p < picture && p < high; ++p) {
      const double share = (std::min(high, p + 1.0) - std::max(low, static_cast<double>(p))) * per_pixel;
      if (share > 0.0) visit(p, static_cast<float>(share));
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
    down.for_each_part(y, [&](int row, float of_row) {
      for (int x = 0; x < grid.frame.width; ++x)
        across.for_each_part(x, [&](int column, float share) { visit(x, y, column, row, of_row * share); });
    });
  }
}

// The frame's pixels along one side, from the first that contains a part of the picture.
void lay_out(int first, int count, int whole, double per_pixel, int& origin, int& length, int& full, double& corner) {
  full = static_cast<int>(std::ceil(whole * per_pixel));
  const double begin = (first - 0.5 * whole) * per_pixel + 0.5 * full;
  origin = static_cast<int>(std::floor(begin));
  length = static_cast<int>(std::ceil(begin + count * per_pixel)) - origin;
  corner = begin - origin;
}

}  // namespace

double squeeze_of(const LensState& lens) {
  if (lens.has_axial_symmetry()) return 1.0;
  const FirstOrder figures = first_order(lens, lens.design_wavelength_nm);
  const double squeeze = std::abs(figures.focal_length_mm / figures.focal_length_x_mm);
  return std::isfinite(squeeze) && std::abs(squeeze - 1.0) > kSquare ? squeeze : 1.0;
}

Result<PixelGrid> pixel_grid(const params::Values& values, const LensState& lens, const PixelWindow& data,
                             const PixelWindow& display, double pixel_aspect) {
  if (display.width < 1 || display.height < 1 || data.width < 1 || data.height < 1)
    return failure(ErrorCode::InvalidArgument, "the display window has no pixels; nothing says where the axis is");
  PixelGrid grid;
  grid.width = data.width;
  grid.height = data.height;
  const double aspect = pixel_aspect / squeeze_of(lens);  // that of a pixel on the sensor
  const bool is_square = std::abs(aspect - 1.0) <= kSquare;
  if (!is_square) grid.per_pixel = {std::max(1.0, aspect), std::max(1.0, 1.0 / aspect)};
  const double square_pixels = grid.per_pixel.x * grid.per_pixel.y;
  if (square_pixels *
          std::max(static_cast<double>(display.width) * display.height, static_cast<double>(data.width) * data.height) >
      params::kMaxPixels)
    return failure(ErrorCode::InvalidArgument, "the picture has more than 2^28 pixels, counted as square ones");

  Frame& frame = grid.frame;
  lay_out(data.x - display.x, data.width, display.width, grid.per_pixel.x, frame.origin_x, frame.width,
          frame.full_width, grid.corner_px.x);
  lay_out(data.y - display.y, data.height, display.height, grid.per_pixel.y, frame.origin_y, frame.height,
          frame.full_height, grid.corner_px.y);
  frame.pixel_pitch_mm =
      params::pixel_pitch_mm(values, lens, {display.width * grid.per_pixel.x, display.height * grid.per_pixel.y});
  return grid;
}

Image picture_of_frame(const Image& frame, const PixelGrid& grid) {
  if (grid.is_square()) return frame;
  Image picture(grid.width, grid.height, frame.channels);
  for_each_part(grid, [&](int x, int y, int column, int row, float share) {
    for (int c = 0; c < frame.channels; ++c) picture.at(column, row, c) += share * frame.at(x, y, c);
  });
  return picture;
}

Result<Image> picture_of_flare(Image frame, const PixelGrid& grid) {
  Image picture = grid.is_square() ? std::move(frame) : picture_of_frame(frame, grid);
  const auto wrong = std::ranges::count_if(picture.pixels, [](float value) { return !std::isfinite(value); });
  if (wrong == 0) return picture;
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("{} samples of the flare are not finite numbers; choose smaller values and gains of the "
                             "lights, and please report it",
                             wrong));
}

Image frame_of_picture(const Image& picture, const PixelGrid& grid) {
  if (grid.is_square()) return picture;
  Image frame(grid.frame.width, grid.frame.height, picture.channels);
  for_each_part(grid, [&](int x, int y, int column, int row, float share) {
    for (int c = 0; c < frame.channels; ++c) frame.at(x, y, c) += share * picture.at(column, row, c);
  });
  return frame;
}

}  // namespace contrejour
