#include "render/area/convolve.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

#include "base/tasks.h"
#include "render/area/convolve_block.h"

namespace contrejour::area {
namespace {

constexpr int kBlock = static_cast<int>(kBlockFloats / 3);  // pixels

// A row of weights without the zeros at its ends; a pattern for each.
struct KernelRow {
  int row = 0, first = 0;  // from the kernel's corner
  int count = 0;
  std::vector<float> patterns;
};

std::vector<KernelRow> rows_of(const Kernel& kernel) {
  std::vector<KernelRow> rows;
  for (int y = 0; y < kernel.height(); ++y) {
    const Rgb* const weights = kernel.weight.data() + static_cast<std::ptrdiff_t>(y) * kernel.width();
    int first = 0, end = kernel.width();
    while (first < end && weights[first] == Rgb{}) ++first;
    while (end > first && weights[end - 1] == Rgb{}) --end;
    if (first == end) continue;
    KernelRow row{y, first, end - first, {}};
    for (int x = first; x < end; ++x)
      for (std::size_t k = 0; k < kPatternFloats; ++k) row.patterns.push_back(static_cast<float>(weights[x][k % 3]));
    rows.push_back(std::move(row));
  }
  return rows;
}

// Where a row of a picture is not 0, in pixels.
struct Span {
  int first = 0, end = 0;
};

Span lit_part(std::span<const float> row) {
  const auto is_lit = [](float v) { return v != 0.0F; };
  const auto first = std::find_if(row.begin(), row.end(), is_lit);
  if (first == row.end()) return {};
  const auto last = std::find_if(row.rbegin(), row.rend(), is_lit);
  return {static_cast<int>(first - row.begin()) / 3, static_cast<int>(row.rend() - last - 1) / 3 + 1};
}

// Rows of the picture and of the kernel that meet in a row of the sum.
struct Meeting {
  const float* picture = nullptr;
  Span lit;
  const KernelRow* kernel = nullptr;
};

// Pixels [x, x + kBlock) of the sum. The kernel's column c meets the picture's pixel x + width - 1 - c.
void add_at(const std::vector<Meeting>& meetings, int x, int kernel_width, std::vector<BlockTerm>& terms, float* to) {
  terms.clear();
  for (const Meeting& m : meetings) {
    const int first = x + kernel_width - 1 - m.kernel->first, least = first - (m.kernel->count - 1);
    if (first + kBlock <= m.lit.first || least >= m.lit.end) continue;
    terms.push_back({m.picture + 3 * static_cast<std::ptrdiff_t>(first), m.kernel->patterns.data(),
                     static_cast<std::size_t>(m.kernel->count)});
  }
  if (!terms.empty()) add_block(terms, to);
}

// The same for a pixel alone.
void add_pixel(const std::vector<Meeting>& meetings, int x, int kernel_width, float* to) {
  for (const Meeting& m : meetings) {
    const float* from = m.picture + 3 * static_cast<std::ptrdiff_t>(x + kernel_width - 1 - m.kernel->first);
    const float* weights = m.kernel->patterns.data();
    for (int k = 0; k < m.kernel->count; ++k, from -= 3, weights += kPatternFloats)
      for (int c = 0; c < 3; ++c) to[c] += weights[c] * from[c];
  }
}

}  // namespace

void add_convolved(Image& to, const Image& picture, const Kernel& kernel, const Context& context) {
  assert(picture.width == to.width + kernel.width() - 1 && picture.height == to.height + kernel.height() - 1);
  const std::vector<KernelRow> rows = rows_of(kernel);
  std::vector<Span> lit(static_cast<std::size_t>(picture.height));
  parallel_for(lit.size(), context, [&](std::size_t y) { lit[y] = lit_part(picture.row(static_cast<int>(y))); });
  parallel_for(static_cast<std::size_t>(to.height), context, [&](std::size_t at) {
    const int y = static_cast<int>(at);
    std::vector<Meeting> meetings;
    for (const KernelRow& row : rows) {
      const int source = y + kernel.height() - 1 - row.row;
      const Span span = lit[static_cast<std::size_t>(source)];
      if (span.first < span.end) meetings.push_back({picture.row(source).data(), span, &row});
    }
    if (meetings.empty()) return;
    std::vector<BlockTerm> terms;
    float* const out = to.row(y).data();
    int x = 0;
    for (; x + kBlock <= to.width; x += kBlock)
      add_at(meetings, x, kernel.width(), terms, out + 3 * static_cast<std::ptrdiff_t>(x));
    for (; x < to.width; ++x) add_pixel(meetings, x, kernel.width(), out + 3 * static_cast<std::ptrdiff_t>(x));
  });
}

}  // namespace contrejour::area
