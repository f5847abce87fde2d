// SPDX-License-Identifier: Apache-2.0
// Turns what edges left in a tile, and light added to single pixels, into pixels of the frame.
#if defined(CONTREJOUR_ADAPTIVE_TILE_PIXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef CONTREJOUR_ADAPTIVE_TILE_PIXELS_INL_H_
#undef CONTREJOUR_ADAPTIVE_TILE_PIXELS_INL_H_
#else
#define CONTREJOUR_ADAPTIVE_TILE_PIXELS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>

#include "render/adaptive/tiles/channel_vector-inl.h"
#include "render/adaptive/tiles/pixels-inl.h"
#include "render/adaptive/tiles/tile_canvas.h"
#include "render/adaptive/tiles/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::inline internal::adaptive::HWY_NAMESPACE {

// Draws a block's pixels of a row to `to`. The sums of the block are read and cleared, also beyond the tile's border.
// line: the row's line before the block, and on return after it.
template <bool kTouched, bool kLit>
HWY_INLINE void draw_block(TileSums& tile, int row, int block, ChannelLine<double>& line, float* to) {
  const int first = TileSums::kBlock * block;
  // Relative to the block, instead of to the tile's border, floats are accurate enough.
  const PixelLine<float> level(ChannelLine<float>{to_floats(line.at(first)), to_floats(line.slope)});
  for (int k = 0; k < TileSums::kBlock; k += PixelsOf<float>::kCount) {
    const std::size_t at = TileSums::kPixel * static_cast<std::size_t>(first + k);
    PixelsOf<float> value = level.at(k);
    if constexpr (kTouched) value = value + taken<float>(tile.pixels_at(row) + at);
    if constexpr (kLit) {
      float* const light = tile.light_at(row) + at;
      value = value + PixelsOf<float>::load(light);
      PixelsOf<float>::all(0.0F).store(light);
    }
    value.store(to + at);
  }
  if constexpr (kTouched) {
    double* const change = tile.change_after(row, block);
    line = line + ChannelLine<double>::load(change);
    ChannelLine<double>::zero().store(change);
  }
}

// Draws a row from its line and from its blocks' own sums, which are cleared; those of untouched blocks are not read.
HWY_INLINE void draw_row(TileSums& tile, int row, const TileCanvas& canvas) {
  const auto at_row = static_cast<std::size_t>(row);
  const std::uint64_t touched = std::exchange(tile.touched[at_row], 0), lit = std::exchange(tile.lit[at_row], 0);
  double* const carried = tile.carried[at_row].data();
  ChannelLine<double> line = ChannelLine<double>::load(carried);

  // A buffer outside the frame, whose memory is then written as a whole.
  HWY_ALIGN float pixels[TileSums::kPixel * TileGrid::kWidth];
  const int blocks = tile.blocks();
  for (int block = 0; block < blocks;) {
    // Draws all blocks up to the next one of another kind, since kinds follow no predictable pattern.
    const auto at = static_cast<unsigned>(block);
    const bool is_touched = (touched >> at & 1U) != 0, is_lit = (lit >> at & 1U) != 0;
    const std::uint64_t others = (is_touched ? ~touched : touched) | (is_lit ? ~lit : lit);
    const int end = std::min(block + std::countr_zero(others >> at), blocks);
    const auto draw = [&](auto of_touched, auto of_lit) HWY_ATTR {
      for (; block < end; ++block) draw_block<of_touched(), of_lit()>(tile, row, block, line, pixels);
    };
    constexpr std::true_type kYes;
    constexpr std::false_type kNo;
    if (is_lit)
      is_touched ? draw(kYes, kYes) : draw(kNo, kYes);
    else
      is_touched ? draw(kYes, kNo) : draw(kNo, kNo);
  }
  const std::size_t count = TileSums::kPixel * static_cast<std::size_t>(tile.width);
  float* const to = canvas.at(tile, row);
  if (canvas.mode == RasterMode::Write)
    canvas.writer.write(pixels, count, to);
  else
    std::transform(pixels, pixels + count, to, to, std::plus<>());
  line.level = line.at(tile.width);
  line.store(carried);
}

void draw_pixels(TileSums& tile, const TileCanvas& canvas) {
  for (int row = 0; row < tile.height; ++row) draw_row(tile, row, canvas);
}

}  // namespace contrejour::inline internal::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
