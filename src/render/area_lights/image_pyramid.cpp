// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/image_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/tasks.h"
#include "image/pixel_writer.h"
#include "render/area_lights/convolve.h"
#include "render/area_lights/upsampling.h"

namespace contrejour::inline internal::area {
namespace {

constexpr int kStencil = static_cast<int>(kUpsamplingStencil);
constexpr int kRowsAtOnce = 16;  // coarse rows that a thread processes at once

int floor_half(int n) { return n >= 0 ? n / 2 : -((1 - n) / 2); }

// One axis of a window of a larger frame: the frame's length, the window's origin, and its displacement.
struct Axis {
  int full = 0, origin = 0;
  double moved = 0.0;
};

// The axis of a frame in pixels `scale` times as wide, for a window that begins at pixel `first` of these. The middle
// of a frame lies on a whole or a half pixel: the nearest one is taken.
Axis coarser_axis(int full, int origin, double scale, int first) {
  const double middle = (0.5 * full - origin) / scale - first;
  const int upsampled = static_cast<int>(std::lround(2.0 * middle));
  Axis axis;
  axis.full = static_cast<int>(std::ceil(full / scale));
  if ((axis.full - upsampled) % 2 != 0) ++axis.full;
  axis.origin = (axis.full - upsampled) / 2;
  axis.moved = 0.5 * upsampled - middle;
  return axis;
}

// Upsamples rows of a coarse picture that has kStencil more pixels on every side: each to the two fine rows that it
// covers.
class RowHalver {
 public:
  RowHalver(const Image& coarse, Upsampling upsampling)
      : coarse_(coarse), upsampling_(upsampling), count_(coarse.row(0).size()), upper_(count_), lower_(count_),
        fine_(2 * count_) {}

  void take(int y) {
    const auto row = [&](int by) { return coarse_.row(y + by).data(); };
    halve_down(upsampling_, {row(-2), row(-1), row(0), row(1), row(2)}, count_, upper_.data(), lower_.data());
  }

  // The upper or the lower fine row, with twice as many pixels as the coarse row. The outermost 2 kStencil pixels on
  // either side are undefined.
  [[nodiscard]] const float* fine(bool lower) {
    upsample_across(upsampling_, lower ? lower_.data() : upper_.data(), count_, fine_.data());
    return fine_.data();
  }

 private:
  const Image& coarse_;
  Upsampling upsampling_;
  std::size_t count_;
  std::vector<float> upper_, lower_, fine_;
};

}  // namespace

ImagePyramid::ImagePyramid(const Frame& frame, Upsampling upsampling)
    : frame_(frame), upsampling_(upsampling), levels_(kLevels) {
  levels_[0] = {0, 0, frame.width, frame.height, {}};
  for (std::size_t k = 1; k < levels_.size(); ++k) {
    const PyramidLevel& fine = levels_[k - 1];
    PyramidLevel& layer = levels_[k];
    layer.left = floor_half(fine.left) - kStencil;
    layer.top = floor_half(fine.top) - kStencil;
    layer.width = floor_half(fine.left + fine.width - 1) + 1 + kStencil - layer.left;
    layer.height = floor_half(fine.top + fine.height - 1) + 1 + kStencil - layer.top;
  }
}

PyramidFrame ImagePyramid::frame_for(int level, KernelExtent extent) const {
  const PyramidLevel& layer = levels_[static_cast<std::size_t>(level)];
  const double scale = std::exp2(level);
  PyramidFrame out;
  out.level = level;
  out.left = layer.left - extent.right;
  out.top = layer.top - extent.down;
  const Axis x = coarser_axis(frame_.full_width, frame_.origin_x, scale, out.left);
  const Axis y = coarser_axis(frame_.full_height, frame_.origin_y, scale, out.top);
  out.frame = {layer.width + extent.left + extent.right,
               layer.height + extent.up + extent.down,
               x.origin,
               y.origin,
               x.full,
               y.full,
               frame_.pixel_pitch_mm * scale,
               frame_.shift_mm};
  out.moved = {x.moved, y.moved};
  return out;
}

void ImagePyramid::add(PicturePart picture, const PyramidFrame& drawn, const Kernel& kernel, double negligible_level,
                       const Context& context) {
  PyramidLevel& layer = levels_[static_cast<std::size_t>(drawn.level)];
  const auto mode = layer.sum.pixels.empty() ? ConvolveMode::Write : ConvolveMode::Add;
  if (mode == ConvolveMode::Write) layer.sum = Image::unwritten(layer.width, layer.height);
  convolve(layer.sum, mode, picture, kernel, negligible_level * std::exp2(2 * drawn.level), context);
}

void ImagePyramid::add_sharp(Image picture, const Context& context) {
  Image& sum = levels_[0].sum;
  if (!sum.pixels.empty()) return add_sharp(PicturePart{picture}, context);
  upsample_to(1, context);
  if (!levels_[1].sum.pixels.empty()) add_upsampled(levels_[1], levels_[0], picture, true, context);
  levels_[1].sum = {};
  sum = std::move(picture);
}

void ImagePyramid::add_sharp(PicturePart picture, const Context& context) {
  upsample_to(0, context);
  Image& sum = levels_[0].sum;
  if (sum.pixels.empty()) sum = Image(frame_.width, frame_.height);
  parallel_for(static_cast<std::size_t>(picture.image.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    const auto in = picture.image.row(y);
    float* const out = sum.row(picture.top + y).data() + 3 * static_cast<std::ptrdiff_t>(picture.left);
    for (std::size_t k = 0; k < in.size(); ++k) out[k] += in[k];
  });
}

void ImagePyramid::upsample_to(int level, const Context& context) {
  for (std::size_t k = levels_.size() - 1; k > static_cast<std::size_t>(level); --k) {
    PyramidLevel &coarse = levels_[k], &fine = levels_[k - 1];
    if (coarse.sum.pixels.empty()) continue;
    const bool is_written = !fine.sum.pixels.empty();
    if (!is_written) fine.sum = Image::unwritten(fine.width, fine.height);
    add_upsampled(coarse, fine, fine.sum, is_written, context);
    coarse.sum = {};
  }
}

void ImagePyramid::add_upsampled(const PyramidLevel& coarse, const PyramidLevel& target, Image& fine, bool is_written,
                                 const Context& context) const {
  const int top = floor_half(target.top), rows = floor_half(target.top + target.height - 1) + 1 - top;
  const auto strips = static_cast<std::size_t>((rows + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_for(strips, context, [&](std::size_t strip) {
    RowHalver halver(coarse.sum, upsampling_);
    const PixelWriter writer(fine);
    const int begin = top + static_cast<int>(strip) * kRowsAtOnce, end = std::min(begin + kRowsAtOnce, top + rows);
    for (int y = begin; y < end; ++y) {
      halver.take(y - coarse.top);
      for (const bool lower : {false, true}) {
        const int fine_y = 2 * y + (lower ? 1 : 0) - target.top;
        if (fine_y < 0 || fine_y >= target.height) continue;
        const float* const from = halver.fine(lower) + static_cast<std::ptrdiff_t>(3) * (target.left - 2 * coarse.left);
        const auto to = fine.row(fine_y);
        for (std::size_t k = 0; is_written && k < to.size(); ++k) to[k] += from[k];
        if (!is_written) writer.write(from, to.size(), to.data());
      }
    }
  });
}

Image ImagePyramid::flattened(const Context& context) && {
  upsample_to(0, context);
  if (levels_[0].sum.pixels.empty()) return {frame_.width, frame_.height};
  return std::move(levels_[0].sum);
}

}  // namespace contrejour::inline internal::area
