#include "render/area/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/tasks.h"
#include "render/area/convolve.h"

namespace contrejour::area {
namespace {

constexpr int kStencil = 2;  // pixels beside its own that a pixel's halves are found from

int floor_half(int n) { return n >= 0 ? n / 2 : -((1 - n) / 2); }

// What a window of a larger frame calls its corner, on one axis.
struct Axis {
  int full = 0, origin = 0;
  double moved = 0.0;
};

// A frame's axis in pixels `scale` times as wide that begin at `first` of them. A frame's middle lies on a whole or a
// half pixel: the nearest of these.
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

// Half of a coarse value that goes to the first or the second of the two places it covers: averages of a polynomial of
// degree 4 stay averages of it (Donoho 1993, average interpolation).
float half_of(float before2, float before1, float here, float after1, float after2, bool second) {
  const float slope = (22.0F * (before1 - after1) - 3.0F * (before2 - after2)) * (1.0F / 128.0F);
  return 0.5F * (second ? here - slope : here + slope);
}

struct Rows {
  const Image* coarse = nullptr;
  int top = 0;  // of the coarse picture, in its pixels

  // The coarse row of a fine one, halved; 3 floats for each of its pixels.
  void halve(int fine_y, std::vector<float>& out) const {
    const int y = floor_half(fine_y) - top;
    const bool second = (fine_y & 1) != 0;
    const std::size_t count = 3 * static_cast<std::size_t>(coarse->width);
    const std::array<const float*, 5> from{coarse->row(y - 2).data(), coarse->row(y - 1).data(), coarse->row(y).data(),
                                           coarse->row(y + 1).data(), coarse->row(y + 2).data()};
    out.resize(count);
    for (std::size_t k = 0; k < count; ++k)
      out[k] = half_of(from[0][k], from[1][k], from[2][k], from[3][k], from[4][k], second);
  }
};

void add_halves(const std::vector<float>& coarse, int coarse_left, int fine_left, int fine_width, float* fine) {
  for (int x = 0; x < fine_width; ++x) {
    const int fine_x = fine_left + x;
    const float* const here = coarse.data() + 3 * (floor_half(fine_x) - coarse_left);
    const bool second = (fine_x & 1) != 0;
    for (int c = 0; c < 3; ++c)
      fine[3 * x + c] += half_of(here[c - 6], here[c - 3], here[c], here[c + 3], here[c + 6], second);
  }
}

}  // namespace

Layers::Layers(const Frame& frame) : frame_(frame), layers_(kLevels) {
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

void Layers::add(const Image& picture, const LayerFrame& drawn, const Kernel& kernel, const Context& context) {
  Layer& layer = layers_[static_cast<std::size_t>(drawn.level)];
  if (layer.sum.pixels.empty()) layer.sum = Image(layer.width, layer.height);
  add_convolved(layer.sum, picture, kernel, context);
}

void Layers::add_sharp(Image picture, const Context& context) {
  Image& sum = layers_[0].sum;
  if (sum.pixels.empty()) {
    sum = std::move(picture);
    return;
  }
  parallel_for(static_cast<std::size_t>(sum.height), context, [&](std::size_t row) {
    const auto out = sum.row(static_cast<int>(row));
    const auto in = picture.row(static_cast<int>(row));
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += in[k];
  });
}

Image Layers::flattened(const Context& context) && {
  for (std::size_t k = layers_.size() - 1; k > 0; --k) {
    const Layer& coarse = layers_[k];
    if (coarse.sum.pixels.empty()) continue;
    Layer& fine = layers_[k - 1];
    if (fine.sum.pixels.empty()) fine.sum = Image(fine.width, fine.height);
    const Rows rows{&coarse.sum, coarse.top};
    parallel_for(static_cast<std::size_t>(fine.height), context, [&](std::size_t row) {
      const int y = static_cast<int>(row);
      std::vector<float> halved;
      rows.halve(fine.top + y, halved);
      add_halves(halved, coarse.left, fine.left, fine.width, fine.sum.row(y).data());
    });
    layers_[k].sum = {};
  }
  if (layers_[0].sum.pixels.empty()) return {frame_.width, frame_.height};
  return std::move(layers_[0].sum);
}

}  // namespace contrejour::area
