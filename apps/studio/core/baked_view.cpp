// SPDX-License-Identifier: Apache-2.0
#include "studio/core/baked_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace contrejour::studio {
namespace {

constexpr float kLinearBelow = 1.0F / 512;  // below it values are spaced linearly
constexpr float kBrightest = 1024;
constexpr int kTableSide = 73;
// A cell is not interpolated if its middle is farther from the view than this many codes, or if the gamut's edge cuts
// it.
constexpr float kMostApart = 0.5F;
constexpr float kSteep = 50;  // codes beyond the display's white
constexpr int kTableRow = kTableSide, kTablePlane = kTableSide * kTableSide;

// The logarithm to base 2 of positive values: a polynomial of the mantissa that is exact at powers of two, elsewhere to
// 2e-4, a thousandth of the table's spacing.
float log2_of(float value) {
  constexpr float kC0 = 0.43807325F, kC1 = -0.23669342F, kC2 = 0.0803073F;  // least squares
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const float f = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U) - 1;
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23U) - 127);
  return exponent + f + f * (1 - f) * (kC0 + f * (kC1 + f * kC2));
}

constexpr float kStart = -9, kStops = 19.0000027F;  // logarithms of kLinearBelow, and of all above it

// The position of a value in the table, 0 to kTableSide - 1.
float place_of(float value) {
  constexpr float kEnd = kTableSide - 1;
  float in_range = value > 0 ? value : 0;  // also where it is not a number
  in_range = in_range < kBrightest ? in_range : kBrightest;
  const float place = (log2_of(in_range + kLinearBelow) - kStart) * (kEnd / kStops);
  return place < 0 ? 0 : place < kEnd ? place : kEnd;
}

float value_at(float place) {
  const float part = place / (kTableSide - 1);
  return kLinearBelow * (std::pow(kBrightest / kLinearBelow + 1, part) - 1);
}

// The places of a block of values: a loop that compilers can turn into vector instructions.
constexpr std::size_t kBlock = 64;  // of pixels

struct BlockCells {
  std::array<int, 3 * kBlock> first{};
  std::array<float, 3 * kBlock> part{};  // towards the next
};

void find_cells(const float* rgb, float gain, std::size_t count, BlockCells& cells) {
  for (std::size_t k = 0; k < count; ++k) {
    const float place = place_of(gain * rgb[k]);
    const int whole = static_cast<int>(place);
    const int first = whole < kTableSide - 2 ? whole : kTableSide - 2;
    cells.first[k] = first;
    cells.part[k] = place - static_cast<float>(first);
  }
}

std::uint32_t rounded_code(float value) {
  const float positive = value > 0 ? value : 0;
  return static_cast<std::uint32_t>((positive < 255 ? positive : 255) + 0.5F);
}

std::uint32_t packed_codes(float r, float g, float b) {
  return rounded_code(r) | rounded_code(g) << 8U | rounded_code(b) << 16U | 0xFF000000U;
}

float rounded_to_range(float code) { return std::isfinite(code) ? 255 * std::clamp(code, -1000.0F, 1000.0F) : 0; }

std::size_t index_of(int r, int g, int b) { return static_cast<std::size_t>(r + g * kTableRow + b * kTablePlane); }

// All triples of these values, red changing fastest.
std::vector<float> grid_of(std::span<const float> values) {
  std::vector<float> rgb;
  rgb.reserve(3 * values.size() * values.size() * values.size());
  for (const float b : values)
    for (const float g : values)
      for (const float r : values) rgb.insert(rgb.end(), {r, g, b});
  return rgb;
}

BakedView::Entry between(const BakedView::Entry& a, const BakedView::Entry& b, float part) {
  BakedView::Entry sum;
  for (std::size_t c = 0; c < 4; ++c) sum[c] = a[c] + part * (b[c] - a[c]);
  return sum;
}

BakedView::Entry between_rows(const BakedView::Entry* first, float part_r, float part_g) {
  const BakedView::Entry* second = first + kTableRow;
  return between(between(first[0], first[1], part_r), between(second[0], second[1], part_r), part_g);
}

// Whether the view bends too sharply in the cell that begins here; `exact`: what it is in the cell's middle.
bool is_rough(const BakedView::Entry* first, const float* exact) {
  const BakedView::Entry middle =
      between(between_rows(first, 0.5F, 0.5F), between_rows(first + kTablePlane, 0.5F, 0.5F), 0.5F);
  for (std::size_t c = 0; c < 3; ++c) {
    float least = first[0][c], most = least;
    for (int corner = 1; corner < 8; ++corner) {
      const float code = first[(corner & 1) + (corner & 2) / 2 * kTableRow + (corner & 4) / 4 * kTablePlane][c];
      least = std::min(least, code);
      most = std::max(most, code);
    }
    const bool is_cut_below = least < -kMostApart && most > kMostApart;
    const bool is_cut_above = least < 255 && most > 255 + kSteep;
    const float apart = std::clamp(middle[c], 0.0F, 255.0F) - std::clamp(255 * exact[c], 0.0F, 255.0F);
    if (is_cut_below || is_cut_above || std::abs(apart) > kMostApart) return true;
  }
  return false;
}

}  // namespace

Result<BakedView> BakedView::bake(ColourView view, ColourSpace space) {
  std::array<float, kTableSide> corners{};
  std::array<float, kTableSide - 1> middles{};
  for (int k = 0; k < kTableSide; ++k) corners[static_cast<std::size_t>(k)] = value_at(static_cast<float>(k));
  for (int k = 0; k + 1 < kTableSide; ++k)
    middles[static_cast<std::size_t>(k)] = value_at(static_cast<float>(k) + 0.5F);
  std::vector<float> at_corners = grid_of(corners), in_cells = grid_of(middles);
  if (auto ok = view.apply(at_corners, space); !ok) return tl::unexpected(ok.error());
  if (auto ok = view.apply(in_cells, space); !ok) return tl::unexpected(ok.error());
  BakedView baked;
  baked.view_ = std::move(view);
  baked.space_ = space;
  baked.table_.resize(at_corners.size() / 3);
  for (std::size_t k = 0; k < baked.table_.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) baked.table_[k][c] = rounded_to_range(at_corners[3 * k + c]);
  const float* exact = in_cells.data();
  for (int b = 0; b + 1 < kTableSide; ++b)
    for (int g = 0; g + 1 < kTableSide; ++g)
      for (int r = 0; r + 1 < kTableSide; ++r, exact += 3) {
        Entry* first = &baked.table_[index_of(r, g, b)];
        (*first)[3] = is_rough(first, exact) ? 1 : 0;
      }
  return baked;
}

Result<void> BakedView::codes(std::span<const float> rgb, float gain, std::span<std::uint32_t> codes) const {
  std::vector<std::size_t> rough;
  BlockCells cells;
  for (std::size_t start = 0; start < codes.size(); start += kBlock) {
    const std::size_t count = std::min(kBlock, codes.size() - start);
    const float* values = rgb.data() + 3 * start;
    find_cells(values, gain, 3 * count, cells);
    for (std::size_t k = 0; k < count; ++k) {
      const int* at = &cells.first[3 * k];
      const float* part = &cells.part[3 * k];
      const Entry* first = &table_[index_of(at[0], at[1], at[2])];
      const Entry code =
          between(between_rows(first, part[0], part[1]), between_rows(first + kTablePlane, part[0], part[1]), part[2]);
      codes[start + k] = packed_codes(code[0], code[1], code[2]);
      const float brightest = gain * std::max(values[3 * k], std::max(values[3 * k + 1], values[3 * k + 2]));
      if ((*first)[3] != 0 || brightest > kBrightest) rough.push_back(start + k);
    }
  }
  return exact_codes(rgb, gain, rough, codes);
}

Result<void> BakedView::exact_codes(std::span<const float> rgb, float gain, std::span<const std::size_t> pixels,
                                    std::span<std::uint32_t> codes) const {
  if (pixels.empty()) return {};
  std::vector<float> values;
  values.reserve(3 * pixels.size());
  for (const std::size_t k : pixels)
    for (std::size_t c = 0; c < 3; ++c) values.push_back(gain * rgb[3 * k + c]);
  if (auto ok = view_.apply(values, space_); !ok) return ok;
  const float* p = values.data();
  for (const std::size_t k : pixels) {
    codes[k] = packed_codes(255 * p[0], 255 * p[1], 255 * p[2]);
    p += 3;
  }
  return {};
}

}  // namespace contrejour::studio
