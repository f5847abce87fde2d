// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/convolve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/tasks.h"
#include "render/area_lights/convolve_block.h"

namespace contrejour::inline internal::area {
namespace {

constexpr int kBlock = static_cast<int>(kBlockFloats / 3);  // pixels

// Whether all channels have the same weights, as for discs and white shapes.
bool is_white(const Kernel& kernel) {
  return std::ranges::all_of(kernel.weight, [](const Rgb& w) { return w[0] == w[1] && w[1] == w[2]; });
}

// A row of weights without the zeros at its ends, in the layout of convolve_block.h.
struct KernelRow {
  int row = 0, first = 0;  // from the kernel's corner
  int count = 0;
  std::vector<float> weights;
};

struct KernelRows {
  int width = 0, height = 0;
  bool white = false;
  std::vector<KernelRow> rows;
  [[nodiscard]] std::size_t floats_each() const { return white ? 1 : kPatternFloats; }
};

KernelRows rows_of(const Kernel& kernel) {
  KernelRows out{kernel.width(), kernel.height(), is_white(kernel), {}};
  for (int y = 0; y < kernel.height(); ++y) {
    const Rgb* const weights = kernel.weight.data() + static_cast<std::ptrdiff_t>(y) * kernel.width();
    int first = 0, end = kernel.width();
    while (first < end && weights[first] == Rgb{}) ++first;
    while (end > first && weights[end - 1] == Rgb{}) --end;
    if (first == end) continue;
    KernelRow row{y, first, end - first, {}};
    for (int x = first; x < end; ++x)
      for (std::size_t k = 0; k < out.floats_each(); ++k) row.weights.push_back(static_cast<float>(weights[x][k % 3]));
    out.rows.push_back(std::move(row));
  }
  return out;
}

// The largest second difference for which an image counts as linear, so that the kernel leaves it unchanged to within
// `negligible_level`; negative for a kernel that displaces the image or does not preserve its flux.
float roughest_second_difference(const Kernel& kernel, double negligible_level) {
  constexpr double kTolerance = 1e-6;
  Rgb sum{}, x{}, y{}, squares{};
  for (std::size_t k = 0; k < kernel.weight.size(); ++k) {
    const int column = static_cast<int>(k) % kernel.width(), row = static_cast<int>(k) / kernel.width();
    const double dx = column - kernel.extent.left, dy = row - kernel.extent.up;
    for (std::size_t c = 0; c < 3; ++c) {
      const double w = kernel.weight[k][c];
      sum[c] += w;
      x[c] += w * dx;
      y[c] += w * dy;
      squares[c] += w * (dx * dx + dy * dy);
    }
  }
  double widest = 1.0;
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(sum[c] - 1.0) + std::abs(x[c]) + std::abs(y[c]) > kTolerance) return -1.0F;
    widest = std::max(widest, squares[c]);
  }
  return static_cast<float>(negligible_level / widest);
}

// Flags of blocks of kBlock pixels of a row, a bit for each.
class BlockMarks {
 public:
  BlockMarks() = default;
  explicit BlockMarks(std::size_t blocks) : words_((blocks + kBits - 1) / kBits, 0) {}

  void set(std::size_t block) { words_[block / kBits] |= std::uint64_t{1} << (block % kBits); }
  void reset(std::size_t block) { words_[block / kBits] &= ~(std::uint64_t{1} << (block % kBits)); }
  [[nodiscard]] bool test(std::size_t block) const { return (words_[block / kBits] >> (block % kBits) & 1U) != 0; }
  [[nodiscard]] bool any() const {
    return std::ranges::any_of(words_, [](std::uint64_t word) { return word != 0; });
  }
  void add(const BlockMarks& other) {
    words_.resize(other.words_.size(), 0);
    for (std::size_t k = 0; k < words_.size(); ++k) words_[k] |= other.words_[k];
  }
  // Also marks that many blocks before each marked one.
  void spread_back(std::size_t blocks) {
    for (std::size_t n = 0; n < blocks; ++n)
      for (std::size_t k = 0; k < words_.size(); ++k)
        words_[k] |= words_[k] >> 1U | (k + 1 < words_.size() ? words_[k + 1] << (kBits - 1) : 0);
  }

 private:
  static constexpr std::size_t kBits = 64;
  std::vector<std::uint64_t> words_;
};

// The blocks of a row of the sum, by what the kernel reads for them from one row of the picture.
struct RowBlocks {
  BlockMarks lit;    // any light
  BlockMarks curved;  // light that is not linear
};

std::size_t blocks_of(std::size_t floats) { return (floats + kBlockFloats - 1) / kBlockFloats; }

BlockMarks lit_blocks(std::span<const float> row) {
  BlockMarks lit(blocks_of(row.size()));
  std::size_t at = 0;
  for (; at + kBlockFloats <= row.size(); at += kBlockFloats)
    if (has_light(row.data() + at)) lit.set(at / kBlockFloats);
  if (std::ranges::any_of(row.subspan(at), [](float v) { return v != 0.0F; })) lit.set(at / kBlockFloats);
  return lit;
}

// The lit blocks in which second differences exceed `threshold`; all lit blocks at the picture's border are included.
BlockMarks curved_blocks(const Image& picture, int y, const BlockMarks& lit, float threshold) {
  BlockMarks curved(lit);
  if (threshold < 0.0F || y == 0 || y + 1 == picture.height) return curved;
  const float *const above = picture.row(y - 1).data(), *const here = picture.row(y).data(),
                     *const below = picture.row(y + 1).data();
  for (std::size_t b = 1; b + 1 < blocks_of(picture.row(y).size()); ++b) {
    const std::size_t at = b * kBlockFloats;
    if (lit.test(b) && !is_curved(above + at, here + at, below + at, threshold)) curved.reset(b);
  }
  return curved;
}

RowBlocks row_blocks(const Image& picture, int y, float threshold, int kernel_width) {
  const auto reached = static_cast<std::size_t>((kBlock + kernel_width - 2) / kBlock);  // read by a block's sums
  RowBlocks blocks;
  blocks.lit = lit_blocks(picture.row(y));
  if (blocks.lit.any()) blocks.curved = curved_blocks(picture, y, blocks.lit, threshold);
  blocks.lit.spread_back(reached);
  blocks.curved.spread_back(reached);
  return blocks;
}

// A row of the picture and the row of the kernel that multiplies it in a row of the sum.
struct Meeting {
  const float* picture = nullptr;
  const BlockMarks* lit = nullptr;  // RowBlocks
  const KernelRow* kernel = nullptr;
};

// Adds pixels [x, x + kBlock) of the sum. The kernel's column c multiplies the picture's pixel x + width - 1 - c.
void add_at(const std::vector<Meeting>& meetings, int x, const KernelRows& kernel, std::vector<BlockTerm>& terms,
            float* to) {
  terms.clear();
  for (const Meeting& m : meetings) {
    if (!m.lit->test(static_cast<std::size_t>(x / kBlock))) continue;
    const int first = x + kernel.width - 1 - m.kernel->first;
    terms.push_back({m.picture + 3 * static_cast<std::ptrdiff_t>(first), m.kernel->weights.data(),
                     static_cast<std::size_t>(m.kernel->count)});
  }
  if (!terms.empty()) (kernel.white ? add_block : add_coloured_block)(terms, to);
}

// The same for a single pixel.
void add_pixel(const std::vector<Meeting>& meetings, int x, const KernelRows& kernel, float* to) {
  for (const Meeting& m : meetings) {
    const float* from = m.picture + 3 * static_cast<std::ptrdiff_t>(x + kernel.width - 1 - m.kernel->first);
    const float* weights = m.kernel->weights.data();
    for (int k = 0; k < m.kernel->count; ++k, from -= 3, weights += kernel.floats_each())
      for (std::size_t c = 0; c < 3; ++c) to[c] += weights[c % kernel.floats_each()] * from[c];
  }
}

}  // namespace

void convolve(Image& to, ConvolveMode mode, PicturePart part, const Kernel& kernel, double negligible_level,
              const Context& context) {
  const Image& picture = part.image;
  const KernelRows rows = rows_of(kernel);
  assert(part.left >= 0 && part.left + picture.width <= to.width + rows.width - 1);
  assert(part.top >= 0 && part.top + picture.height <= to.height + rows.height - 1);
  std::vector<RowBlocks> blocks(static_cast<std::size_t>(picture.height));
  const float roughest = roughest_second_difference(kernel, negligible_level);
  parallel_for(blocks.size(), context,
               [&](std::size_t at) { blocks[at] = row_blocks(picture, static_cast<int>(at), roughest, rows.width); });
  const int width = picture.width - rows.width + 1;  // of the sum, as far as the part determines it
  parallel_for(static_cast<std::size_t>(to.height), context, [&](std::size_t at) {
    const auto to_row = to.row(static_cast<int>(at));
    if (mode == ConvolveMode::Write) std::ranges::fill(to_row, 0.0F);
    const int y = static_cast<int>(at) - part.top;
    if (y < 0 || y + rows.height > picture.height || width <= 0) return;
    std::vector<Meeting> meetings;
    RowBlocks together;
    for (const KernelRow& row : rows.rows) {
      const int from = y + rows.height - 1 - row.row;
      const RowBlocks& source = blocks[static_cast<std::size_t>(from)];
      if (!source.lit.any()) continue;
      meetings.push_back({picture.row(from).data(), &source.lit, &row});
      together.lit.add(source.lit);
      together.curved.add(source.curved);
    }
    if (meetings.empty()) return;
    std::vector<BlockTerm> terms;
    float* const out = to_row.data() + 3 * static_cast<std::ptrdiff_t>(part.left);
    const float* const straight =
        picture.row(y + kernel.extent.down).data() + 3 * static_cast<std::ptrdiff_t>(kernel.extent.right);
    int x = 0;
    for (; x + kBlock <= width; x += kBlock) {
      const auto b = static_cast<std::size_t>(x / kBlock);
      const std::ptrdiff_t first = 3 * static_cast<std::ptrdiff_t>(x);
      if (together.curved.test(b))
        add_at(meetings, x, rows, terms, out + first);
      else if (together.lit.test(b))
        for (std::size_t k = 0; k < kBlockFloats; ++k) out[first + k] += straight[first + k];
    }
    if (x == width || !together.lit.test(static_cast<std::size_t>(x / kBlock))) return;
    for (; x < width; ++x) add_pixel(meetings, x, rows, out + 3 * static_cast<std::ptrdiff_t>(x));
  });
}

}  // namespace contrejour::inline internal::area
