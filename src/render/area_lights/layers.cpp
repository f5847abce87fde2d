// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/layers.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/tasks.h"
#include "image/pixel_writer.h"
#include "render/area_lights/convolve.h"
#include "render/area_lights/halves.h"

namespace contrejour::inline internal::area {
namespace {

constexpr int kStencil = static_cast<int>(kHalvesStencil);
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
  const int halves = static_cast<int>(std::lround(2.0 * middle));
  Axis axis;
  axis.full = static_cast<int>(std::ceil(full / scale));
  if ((axis.full - halves) % 2 != 0) ++axis.full;
  axis.origin = (axis.full - halves) / 2;
  axis.moved = 0.5 * halves - middle;
  return axis;
}

// Upsamples rows of a coarse picture that has kStencil more pixels on every side: each to the two fine rows that it
// covers.
class RowHalver {
 public:
  RowHalver(const Image& coarse, Halving halving)
      : coarse_(coarse), halving_(halving), count_(coarse.row(0).size()), upper_(count_), lower_(count_),
        fine_(2 * count_) {}

  void take(int y) {
    const auto row = [&](int by) { return coarse_.row(y + by).data(); };
    halve_down(halving_, {row(-2), row(-1), row(0), row(1), row(2)}, count_, upper_.data(), lower_.data());
  }

  // The upper or the lower fine row, with twice as many pixels as the coarse row. The outermost 2 kStencil pixels on
  // either side are undefined.
  [[nodiscard]] const float* fine(bool lower) {
    halve_across(halving_, lower ? lower_.data() : upper_.data(), count_, fine_.data());
    return fine_.data();
  }

 private:
  const Image& coarse_;
  Halving halving_;
  std::size_t count_;
  std::vector<float> upper_, lower_, fine_;
};

}  // namespace

Layers::Layers(const Frame& frame, Halving halving) : frame_(frame), halving_(halving), layers_(kLevels) {
  layers_[0] = {0, 0, frame.width, frame.height, {}};
  for (std::size_t k = 1; k < layers_.size(); ++k) {
    const Layer& fine = layers_[k - 1];
    Layer& layer = layers_[k];
    layer.left = floor_half(fine.left) - kStencil;
    layer.top = floor_half(fine.top) - kStencil;
    layer.width = floor_half(fine.left + fine.width - 1) + 1 + kStencil - layer.left;
    layer.height = floor_half(fine.top + fine.height - 1) + 1 + kStencil - layer.top;
  }
}

LayerFrame Layers::frame_for(int level, KernelReach reach) const {
  const Layer& layer = layers_[static_cast<std::size_t>(level)];
  const double scale = std::exp2(level);
  LayerFrame out;
  out.level = level;
  out.left = layer.left - reach.right;
  out.top = layer.top - reach.down;
  const Axis x = coarser_axis(frame_.full_width, frame_.origin_x, scale, out.left);
  const Axis y = coarser_axis(frame_.full_height, frame_.origin_y, scale, out.top);
  out.frame = {
      layer.width + reach.left + reach.right, layer.height + reach.up + reach.down, x.origin, y.origin, x.full, y.full,
      frame_.pixel_pitch_mm * scale};
  out.moved = {x.moved, y.moved};
  return out;
}

void Layers::add(PicturePart picture, const LayerFrame& drawn, const Kernel& kernel, double unseen,
                 const Context& context) {
  Layer& layer = layers_[static_cast<std::size_t>(drawn.level)];
  const auto mode = layer.sum.pixels.empty() ? ConvolveMode::Write : ConvolveMode::Add;
  if (mode == ConvolveMode::Write) layer.sum = Image::unwritten(layer.width, layer.height);
  convolve(layer.sum, mode, picture, kernel, unseen * std::exp2(2 * drawn.level), context);
}

void Layers::add_sharp(Image picture, const Context& context) {
  Image& sum = layers_[0].sum;
  if (!sum.pixels.empty()) return add_sharp(PicturePart{picture}, context);
  descend_to(1, context);
  if (!layers_[1].sum.pixels.empty()) add_halves(layers_[1], layers_[0], picture, true, context);
  layers_[1].sum = {};
  sum = std::move(picture);
}

void Layers::add_sharp(PicturePart picture, const Context& context) {
  descend_to(0, context);
  Image& sum = layers_[0].sum;
  if (sum.pixels.empty()) sum = Image(frame_.width, frame_.height);
  parallel_for(static_cast<std::size_t>(picture.image.height), context, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    const auto in = picture.image.row(y);
    float* const out = sum.row(picture.top + y).data() + 3 * static_cast<std::ptrdiff_t>(picture.left);
    for (std::size_t k = 0; k < in.size(); ++k) out[k] += in[k];
  });
}

void Layers::descend_to(int level, const Context& context) {
  for (std::size_t k = layers_.size() - 1; k > static_cast<std::size_t>(level); --k) {
    Layer &coarse = layers_[k], &fine = layers_[k - 1];
    if (coarse.sum.pixels.empty()) continue;
    const bool is_written = !fine.sum.pixels.empty();
    if (!is_written) fine.sum = Image::unwritten(fine.width, fine.height);
    add_halves(coarse, fine, fine.sum, is_written, context);
    coarse.sum = {};
  }
}

void Layers::add_halves(const Layer& coarse, const Layer& place, Image& fine, bool is_written,
                        const Context& context) const {
  const int top = floor_half(place.top), rows = floor_half(place.top + place.height - 1) + 1 - top;
  const auto strips = static_cast<std::size_t>((rows + kRowsAtOnce - 1) / kRowsAtOnce);
  parallel_for(strips, context, [&](std::size_t strip) {
    RowHalver halver(coarse.sum, halving_);
    const PixelWriter writer(fine);
    const int begin = top + static_cast<int>(strip) * kRowsAtOnce, end = std::min(begin + kRowsAtOnce, top + rows);
    for (int y = begin; y < end; ++y) {
      halver.take(y - coarse.top);
      for (const bool lower : {false, true}) {
        const int fine_y = 2 * y + (lower ? 1 : 0) - place.top;
        if (fine_y < 0 || fine_y >= place.height) continue;
        const float* const from = halver.fine(lower) + static_cast<std::ptrdiff_t>(3) * (place.left - 2 * coarse.left);
        const auto to = fine.row(fine_y);
        for (std::size_t k = 0; is_written && k < to.size(); ++k) to[k] += from[k];
        if (!is_written) writer.write(from, to.size(), to.data());
      }
    }
  });
}

Image Layers::flattened(const Context& context) && {
  descend_to(0, context);
  if (layers_[0].sum.pixels.empty()) return {frame_.width, frame_.height};
  return std::move(layers_[0].sum);
}

}  // namespace contrejour::inline internal::area
