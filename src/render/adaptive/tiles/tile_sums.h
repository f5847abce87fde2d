// What edges leave behind in a tile, until a pass along its rows turns it into pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "render/adaptive/tiles/tiles.h"

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

// A tile's place in the frame, and its sums. An edge changes the pixels of the blocks of columns that it lies in, each
// by itself, and the line that light is along the row from the next block on. Tiles of a row are drawn from left to
// right: what edges left of a tile changed it has from the one before.
struct TileSums {
  static constexpr int kBlock = 8;  // columns
  static constexpr int kMostBlocks = TileGrid::kWidth / kBlock;
  static constexpr std::size_t kPixel = 3;  // values
  static constexpr std::size_t kLine = 8;  // three and a spare: level at the tile's first column, then slope along x
  static constexpr float kUnseenCover = 1e-6F;  // of a pixel: rounding beside a polygon
  static_assert(TileGrid::kWidth % kBlock == 0 && kMostBlocks <= 64);

  int x0 = 0, y0 = 0, width = 0, height = 0;
  using Blocks = std::array<std::uint64_t, TileGrid::kHeight>;  // by row, a bit for each block of columns
  Blocks touched{};  // by edges: those have light of their own, and the line may change after them
  Blocks lit{};  // by pixels behind screens
  std::array<std::array<double, kLine>, TileGrid::kHeight> carried{};  // by row: the line left of the first column
  CoverSums cover;

  [[nodiscard]] bool is_carried() const { return x0 > 0; }  // what edges left of it changed
  [[nodiscard]] int blocks() const { return (width + kBlock - 1) / kBlock; }
  // What the line changes by after a block.
  [[nodiscard]] double* change_after(int row, int block) {
    return room_->changes.data() + kLine * static_cast<std::size_t>(row * kMostBlocks + block);
  }
  [[nodiscard]] double* pixels_at(int row) {
    return room_->pixels.data() + kPixel * kPixelPitch * static_cast<std::size_t>(row);
  }
  // Blocks from first to last, last one included.
  void touch(int row, int first, int last) {
    const std::uint64_t to_last = ~std::uint64_t{0} >> static_cast<unsigned>(63 - last);
    touched[static_cast<std::size_t>(row)] |= to_last & (~std::uint64_t{0} << static_cast<unsigned>(first));
  }
  // What comes pixel by pixel, of which no part takes another's away: floats.
  void make_light() {
    if (light_ == nullptr) light_ = std::make_unique<Light>();
  }
  [[nodiscard]] float* light_at(int row) {
    return light_->values.data() + kPixel * kPixelPitch * static_cast<std::size_t>(row);
  }
  // groups: a bit for each kBlock columns from `first` on.
  void light_groups(int row, int first, std::uint64_t groups) {
    groups <<= static_cast<unsigned>(first / kBlock);
    lit[static_cast<std::size_t>(row)] |= first % kBlock == 0 ? groups : groups | groups << 1U;
  }

 private:
  // No power of two: rows share no lines of the cache. Groups that begin within a block end beyond the last one.
  static constexpr std::size_t kPixelPitch = TileGrid::kWidth + 24;
  struct alignas(64) Room {
    std::array<double, kLine * kMostBlocks * TileGrid::kHeight> changes{};
    std::array<double, kPixel * kPixelPitch * TileGrid::kHeight + 1> pixels{};  // and a spare
  };
  struct alignas(64) Light {
    std::array<float, kPixel * kPixelPitch * TileGrid::kHeight> values{};
  };
  std::unique_ptr<Room> room_ = std::make_unique<Room>();
  std::unique_ptr<Light> light_;  // made with the first polygon behind a screen
};

}  // namespace contrejour::adaptive
