// What edges left in a tile, and light that came pixel by pixel, as pixels of the frame.
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

#include "contrejour/image.h"
#include "render/adaptive/quad-inl.h"
#include "render/adaptive/tile_sums.h"

HWY_BEFORE_NAMESPACE();
namespace contrejour::adaptive::HWY_NAMESPACE {

// A block of columns from x0 on, each pixel as four floats, three of them apart: a float after the last one is
// overwritten. Changes and light are taken, beyond the tile's border, too; `line` is the row's sums before the block,
// then after it.
template <bool kChanges, bool kLight>
HWY_INLINE void draw_block(TileSums& tile, int row, int x0, QuadLine<double>& line, float* to) {
  [[maybe_unused]] double* const changes = tile.at(row, x0);
  [[maybe_unused]] float* const light = kLight ? tile.pixels_at(row) + kQuad * static_cast<std::size_t>(x0) : nullptr;
  // Seen from here, not from the tile's border, a float holds it.
  [[maybe_unused]] const QuadLine<float> level{to_floats(line.at(x0)), to_floats(line.slope)};
  for (std::size_t k = 0; k < TileSums::kBlock; ++k) {
    Quad value;
    if constexpr (kChanges) {
      line = line + QuadLine<double>::load(changes + TileSums::kLanes * k);
      QuadLine<double>::zero().store(changes + TileSums::kLanes * k);
      value = to_floats(line.at(x0 + static_cast<double>(k)));
    } else {
      value = level.at(static_cast<float>(k));
    }
    if constexpr (kLight) {
      value = value + Quad::load(light + kQuad * k);
      Quad::all(0.0F).store(light + kQuad * k);
    }
    value.store(to + 3 * k);
  }
}

// Running sums of a row and what came pixel by pixel; both are cleared. Blocks without changes or light are not looked
// at.
HWY_INLINE void draw_row(TileSums& tile, int row, TileMode mode, float* to) {
  const auto at_row = static_cast<std::size_t>(row);
  const std::uint64_t changed = std::exchange(tile.touched[at_row], 0);
  const std::uint64_t lit = std::exchange(tile.lit[at_row], 0);
  double* const carried = tile.carried[at_row].data();
  QuadLine<double> line = QuadLine<double>::load(carried);

  // Beside the frame, since columns are no whole vectors: few wide writes wait less for memory than many small ones.
  HWY_ALIGN float pixels[3 * TileGrid::kWidth + 1];
  const int blocks = (tile.width + TileSums::kBlock - 1) / TileSums::kBlock;
  for (int block = 0; block < blocks;) {
    // As far as they are of one kind: what comes next has no pattern.
    const bool has_changes = (changed >> block & 1U) != 0, has_light = (lit >> block & 1U) != 0;
    const std::uint64_t others = (has_changes ? ~changed : changed) | (has_light ? ~lit : lit);
    const int end = std::min(block + std::countr_zero(others >> block), blocks);
    const auto draw = [&](auto changes, auto light) HWY_ATTR {
      for (; block < end; ++block) {
        const int x0 = TileSums::kBlock * block;
        draw_block<changes(), light()>(tile, row, x0, line, pixels + 3 * x0);
      }
    };
    constexpr std::true_type kYes;
    constexpr std::false_type kNo;
    if (has_changes)
      has_light ? draw(kYes, kYes) : draw(kYes, kNo);
    else
      has_light ? draw(kNo, kYes) : draw(kNo, kNo);
  }
  const std::size_t count = 3 * static_cast<std::size_t>(tile.width);
  if (mode == TileMode::Write)
    std::copy_n(pixels, count, to);
  else
    std::transform(pixels, pixels + count, to, to, std::plus<>());

  double* const border = tile.at(row, tile.width);
  line = line + QuadLine<double>::load(border);
  QuadLine<double>::zero().store(border);
  line.level = line.at(tile.width);
  line.store(carried);
}

void draw_pixels(TileSums& tile, TileMode mode, Image& image) {
  for (int row = 0; row < tile.height; ++row)
    draw_row(tile, row, mode, image.pixels.data() + image.index(tile.x0, tile.y0 + row));
}

}  // namespace contrejour::adaptive::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
