#include "render/area/convolve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/tasks.h"
#include "render/area/convolve_block.h"

namespace contrejour::area {
namespace {

constexpr int kBlock = static_cast<int>(kBlockFloats / 3);  // pixels

// Whether all channels have the same weights, as for discs and white shapes.
bool is_white(const Kernel& kernel) {
  return std::ranges::all_of(kernel.weight, [](const Rgb& w) { return w[0] == w[1] && w[1] == w[2]; });
}

// A row of weights without the zeros at its ends, as convolve_block.h has them.
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

// What second differences may be for a picture to count as linear, which its kernel leaves as it is; below 0 for a
// kernel that moves it or does not keep its light.
float roughest_second_difference(const Kernel& kernel, double unseen) {
  constexpr double kBeside = 1e-6;
  Rgb sum{}, x{}, y{}, squares{};
  for (std::size_t k = 0; k < kernel.weight.size(); ++k) {
    const double dx = static_cast<double>(k % static_cast<std::size_t>(kernel.width())) - kernel.reach.left;
    const double dy = static_cast<double>(k / static_cast<std::size_t>(kernel.width())) - kernel.reach.up;
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
    if (std::abs(sum[c] - 1.0) + std::abs(x[c]) + std::abs(y[c]) > kBeside) return -1.0F;
    widest = std::max(widest, squares[c]);
  }
  return static_cast<float>(unseen / widest);
}

// By blocks of kBlock pixels of a row of the sum, what a kernel finds where it takes a row of the picture.
struct RowBlocks {
  std::vector<std::uint8_t> lit;    // any light
  std::vector<std::uint8_t> rough;  // light that is not linear
  bool any = false;                 // light at all
};

// From marks of the picture's own blocks.
void widen(std::vector<std::uint8_t>& marks, int kernel_width) {
  const auto more = static_cast<std::size_t>((kBlock + kernel_width - 2) / kBlock);  // that a block's sums reach into
  for (std::size_t b = 0; b < marks.size(); ++b)
    for (std::size_t k = b + 1; k <= std::min(b + more, marks.size() - 1); ++k) marks[b] |= marks[k];
}

std::vector<std::uint8_t> lit_blocks(std::span<const float> row) {
  std::vector<std::uint8_t> lit;
  std::size_t at = 0;
  for (; at + kBlockFloats <= row.size(); at += kBlockFloats) lit.push_back(has_light(row.data() + at) ? 1 : 0);
  const auto rest = row.subspan(at);
  if (!rest.empty()) lit.push_back(std::ranges::any_of(rest, [](float v) { return v != 0.0F; }) ? 1 : 0);
  return lit;
}

// Lit ones where second differences are more than that; those at the picture's border count as such.
std::vector<std::uint8_t> rough_blocks(const Image& picture, int y, const std::vector<std::uint8_t>& lit, float most) {
  std::vector<std::uint8_t> rough(lit);
  if (most < 0.0F || y == 0 || y + 1 == picture.height) return rough;
  const float *const above = picture.row(y - 1).data(), *const here = picture.row(y).data(),
                     *const below = picture.row(y + 1).data();
  for (std::size_t b = 1; b + 1 < lit.size(); ++b) {
    const std::size_t at = b * kBlockFloats;
    if (lit[b] != 0) rough[b] = is_rough(above + at, here + at, below + at, most) ? 1 : 0;
  }
  return rough;
}

// Rows of the picture and of the kernel that meet in a row of the sum.
struct Meeting {
  const float* picture = nullptr;
  const std::uint8_t* lit = nullptr;  // RowBlocks
  const KernelRow* kernel = nullptr;
};

// Pixels [x, x + kBlock) of the sum. The kernel's column c meets the picture's pixel x + width - 1 - c.
void add_at(const std::vector<Meeting>& meetings, int x, const KernelRows& kernel, std::vector<BlockTerm>& terms,
            float* to) {
  terms.clear();
  for (const Meeting& m : meetings) {
    if (m.lit[x / kBlock] == 0) continue;
    const int first = x + kernel.width - 1 - m.kernel->first;
    terms.push_back({m.picture + 3 * static_cast<std::ptrdiff_t>(first), m.kernel->weights.data(),
                     static_cast<std::size_t>(m.kernel->count)});
  }
  if (!terms.empty()) (kernel.white ? add_block : add_coloured_block)(terms, to);
}

// The same for a pixel alone.
void add_pixel(const std::vector<Meeting>& meetings, int x, const KernelRows& kernel, float* to) {
  for (const Meeting& m : meetings) {
    const float* from = m.picture + 3 * static_cast<std::ptrdiff_t>(x + kernel.width - 1 - m.kernel->first);
    const float* weights = m.kernel->weights.data();
    for (int k = 0; k < m.kernel->count; ++k, from -= 3, weights += kernel.floats_each())
      for (std::size_t c = 0; c < 3; ++c) to[c] += weights[c % kernel.floats_each()] * from[c];
  }
}

}  // namespace

void convolve(Image& to, ConvolveMode mode, const Image& picture, const Kernel& kernel, double unseen,
              const Context& context) {
  assert(picture.width == to.width + kernel.width() - 1 && picture.height == to.height + kernel.height() - 1);
  const KernelRows rows = rows_of(kernel);
  std::vector<RowBlocks> blocks(static_cast<std::size_t>(picture.height));
  const float roughest = roughest_second_difference(kernel, unseen);
  parallel_for(blocks.size(), context, [&](std::size_t at) {
    const int y = static_cast<int>(at);
    blocks[at].lit = lit_blocks(picture.row(y));
    blocks[at].any = std::ranges::any_of(blocks[at].lit, [](std::uint8_t b) { return b != 0; });
    if (!blocks[at].any) return;
    blocks[at].rough = rough_blocks(picture, y, blocks[at].lit, roughest);
    widen(blocks[at].lit, rows.width);
    widen(blocks[at].rough, rows.width);
  });
  parallel_for(static_cast<std::size_t>(to.height), context, [&](std::size_t at) {
    const int y = static_cast<int>(at);
    if (mode == ConvolveMode::Write) std::ranges::fill(to.row(y), 0.0F);
    std::vector<Meeting> meetings;
    RowBlocks together;
    for (const KernelRow& row : rows.rows) {
      const auto source = static_cast<std::size_t>(y + rows.height - 1 - row.row);
      if (!blocks[source].any) continue;
      together.lit.resize(blocks[source].lit.size());
      together.rough.resize(blocks[source].lit.size());
      meetings.push_back({picture.row(static_cast<int>(source)).data(), blocks[source].lit.data(), &row});
      for (std::size_t b = 0; b < together.lit.size(); ++b) {
        together.lit[b] |= blocks[source].lit[b];
        together.rough[b] |= blocks[source].rough[b];
      }
    }
    if (meetings.empty()) return;
    std::vector<BlockTerm> terms;
    float* const out = to.row(y).data();
    const float* const straight =
        picture.row(y + kernel.reach.down).data() + 3 * static_cast<std::ptrdiff_t>(kernel.reach.right);
    int x = 0;
    for (; x + kBlock <= to.width; x += kBlock) {
      const auto b = static_cast<std::size_t>(x / kBlock);
      const std::ptrdiff_t first = 3 * static_cast<std::ptrdiff_t>(x);
      if (together.rough[b] != 0)
        add_at(meetings, x, rows, terms, out + first);
      else if (together.lit[b] != 0)
        for (std::size_t k = 0; k < kBlockFloats; ++k) out[first + k] += straight[first + k];
    }
    for (; x < to.width; ++x) add_pixel(meetings, x, rows, out + 3 * static_cast<std::ptrdiff_t>(x));
  });
}

}  // namespace contrejour::area
