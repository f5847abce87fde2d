// What edges leave behind in a tile, until running sums along its rows turn it into pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "render/adaptive/tiles.h"

namespace contrejour::adaptive {

// A polygon's coverage alone, as changes along the rows of a tile, in floats: a row ends with the polygon, so that
// rounding goes no farther. Edges left of the tile count as on its border. Rows lie close together, as wide as the
// polygon: the same little memory for every one, as near to the processor as can be.
struct CoverSums {
  static constexpr int kGroup = 8;  // columns, of which whole ones are looked at
  struct Columns {  // none if last < first
    int first, last;
  };
  // By row, and a vector beyond, the columns that some edges changed: coverage is what it was before the first one, and
  // from the last one on what they make it.
  class Changed {
   public:
    Changed() {
      first_.fill(kNone.first);
      last_.fill(kNone.last);
    }
    [[nodiscard]] std::int32_t* firsts(int row) { return first_.data() + row; }
    [[nodiscard]] std::int32_t* lasts(int row) { return last_.data() + row; }
    void add(int row, int first, int last) {
      *firsts(row) = std::min(*firsts(row), first);
      *lasts(row) = std::max(*lasts(row), last);
    }
    // A row's, which are forgotten.
    [[nodiscard]] Columns take(int row) {
      return {std::exchange(*firsts(row), kNone.first), std::exchange(*lasts(row), kNone.last)};
    }

   private:
    static constexpr Columns kNone{std::numeric_limits<int>::max(), -1};
    using OfRows = std::array<std::int32_t, TileGrid::kHeight + kGroup>;
    OfRows first_, last_;
  };

  int width = 0, height = 0;
  Changed begun, ended;  // by edges that the polygon is to the right of, and by the others

  [[nodiscard]] static constexpr bool is_carried() { return false; }  // TileSums has another answer
  // Of the tile, for a polygon that lies within the columns from first to last; all sums must be 0.
  void set_columns(int first, int last) {
    constexpr int kBeyond = 2;  // edges add to so many columns after the one they are in
    first_ = first / kGroup * kGroup;
    pitch_ = (last + kBeyond - first_) / kGroup * kGroup + 2 * kGroup;
    if (room_ == nullptr) room_ = std::make_unique<Room>();
  }
  [[nodiscard]] float* at(int row, int column) {
    return room_->sums.data() + static_cast<std::ptrdiff_t>(row) * pitch_ + (column - first_);
  }
  [[nodiscard]] Changed& changed_by(double sign) { return sign > 0.0 ? begun : ended; }

 private:
  struct alignas(64) Room {  // and a vector beyond
    std::array<float, static_cast<std::size_t>(TileGrid::kWidth + 3 * kGroup) * TileGrid::kHeight + kGroup> sums{};
  };
  int first_ = 0, pitch_ = 0;
  std::unique_ptr<Room> room_;  // made with the first polygon
};

// A tile's place in the frame, and its sums. Tiles of a row are drawn from left to right: what edges left of a tile
// changed it has from the one before.
struct TileSums {
  static constexpr std::size_t kLanes = 8;  // three channels and a spare: level, then slope along x
  static constexpr std::size_t kPitch = TileGrid::kWidth + 3;  // and what edges on the right border change

  static constexpr std::size_t kPixel = kLanes / 2;  // values of a pixel
  static constexpr std::size_t kPixelPitch =
      TileGrid::kWidth + 24;  // no power of two: rows share no lines of the cache
  static constexpr int kBlock = 8;  // columns
  static constexpr float kUnseenCover = 1e-6F;  // of a pixel: rounding beside a polygon
  static_assert(TileGrid::kWidth <= 64 * kBlock);

  int x0 = 0, y0 = 0, width = 0, height = 0;
  using Blocks = std::array<std::uint64_t, TileGrid::kHeight>;  // by row, a bit for each block of columns
  Blocks touched{};  // by changes
  std::vector<double> sums = std::vector<double>(kLanes * kPitch * TileGrid::kHeight, 0.0);
  std::array<std::array<double, kLanes>, TileGrid::kHeight> carried{};  // by row: sums left of the first column
  Blocks lit{};  // pixel by pixel
  struct alignas(64) Light {
    std::array<float, kPixel * kPixelPitch * TileGrid::kHeight> values{};
  };
  std::unique_ptr<Light> by_pixel;  // that came so, kPixel values each, whole blocks; null: none yet
  CoverSums cover;

  [[nodiscard]] bool is_carried() const { return x0 > 0; }  // what edges left of it changed
  [[nodiscard]] double* at(int row, int column) {
    return sums.data() + kLanes * (static_cast<std::size_t>(row) * kPitch + static_cast<std::size_t>(column));
  }
  [[nodiscard]] float* pixels_at(int row) {
    return by_pixel->values.data() + kPixel * kPixelPitch * static_cast<std::size_t>(row);
  }
  // Columns first to last, last one included and the right border's left out.
  void touch(int row, int first, int last) { mark(touched, row, first, last); }
  // groups: a bit for each kBlock columns from `first` on.
  void light_groups(int row, int first, std::uint64_t groups) {
    const auto shift = static_cast<unsigned>(first / kBlock);
    groups <<= shift;
    lit[static_cast<std::size_t>(row)] |= first % kBlock == 0 ? groups : groups | groups << 1U;
  }

 private:
  static void mark(Blocks& blocks, int row, int first, int last) {
    const int most = TileGrid::kWidth / kBlock - 1;
    const int low = std::min(first / kBlock, most);
    const int high = std::min(last / kBlock, most);
    blocks[static_cast<std::size_t>(row)] |= (~std::uint64_t{0} >> (most - high)) & (~std::uint64_t{0} << low);
  }
};

}  // namespace contrejour::adaptive
