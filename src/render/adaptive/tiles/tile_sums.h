// SPDX-License-Identifier: Apache-2.0
// The accumulators hold the changes that edges make in a tile, until a pass along its rows sums them into pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "render/adaptive/tiles/tiles.h"

namespace contrejour::inline internal::adaptive {

// The coverage of one polygon as changes along the rows of a tile, in floats: a row ends with the polygon, so that
// rounding errors do not spread. Edges left of the tile count as on its border. Rows are stored as wide as the polygon,
// so that every polygon uses the same small memory, which stays in the nearest cache.
struct CoverageSums {
  static constexpr int kGroup = 8;  // columns; whole groups are read
  struct Columns {  // none if last < first
    int first, last;
  };
  // For each row, and for a vector of rows beyond, the columns that some edges changed: before the first one coverage
  // is unchanged, after the last one it is constant.
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
    // Returns a row's columns, and forgets them.
    [[nodiscard]] Columns take(int row) {
      return {std::exchange(*firsts(row), kNone.first), std::exchange(*lasts(row), kNone.last)};
    }

   private:
    static constexpr Columns kNone{std::numeric_limits<int>::max(), -1};
    using OfRows = std::array<std::int32_t, TileGrid::kHeight + kGroup>;
    OfRows first_, last_;
  };

  int width = 0, height = 0;
  Changed begun, ended;  // by edges with the polygon on their right, and by the others

  [[nodiscard]] static constexpr bool is_carried() { return false; }  // unlike TileSums
  // Sets the columns, from first to last, that contain the polygon. All sums must be 0.
  void set_columns(int first, int last) {
    constexpr int kBeyond = 2;  // number of columns after its own to which an edge adds
    first_ = first / kGroup * kGroup;
    pitch_ = (last + kBeyond - first_) / kGroup * kGroup + 2 * kGroup;
    if (storage_ == nullptr) storage_ = std::make_unique<Storage>();
  }
  [[nodiscard]] float* at(int row, int column) {
    return storage_->sums.data() + static_cast<std::ptrdiff_t>(row) * pitch_ + (column - first_);
  }
  [[nodiscard]] Changed& changed_by(double sign) { return sign > 0.0 ? begun : ended; }
  [[nodiscard]] std::size_t bytes() const { return storage_ ? sizeof(Storage) : 0; }

 private:
  struct alignas(64) Storage {  // with a vector beyond
    std::array<float, static_cast<std::size_t>(TileGrid::kWidth + 3 * kGroup) * TileGrid::kHeight + kGroup> sums{};
  };
  int first_ = 0, pitch_ = 0;
  std::unique_ptr<Storage> storage_;  // made with the first polygon
};

// The position of a tile in the frame, and its sums. An edge changes single pixels in the blocks of columns in which it
// lies, and, from the next block on, the linear function that the light is along the row. Tiles of a row are drawn from
// left to right; each receives from the one before what edges to its left have changed.
struct TileSums {
  static constexpr int kBlock = 8;  // columns
  static constexpr int kMaxBlocks = TileGrid::kWidth / kBlock;
  static constexpr std::size_t kPixel = 3;  // values
  static constexpr std::size_t kLine = 8;  // four each: level at the tile's first column, slope along x
  static constexpr float kNegligibleCoverage = 1e-6F;  // of a pixel: rounding next to a polygon
  static_assert(TileGrid::kWidth % kBlock == 0 && kMaxBlocks <= 64);

  int x0 = 0, y0 = 0, width = 0, height = 0;
  using Blocks = std::array<std::uint64_t, TileGrid::kHeight>;  // by row, a bit for each block of columns
  Blocks touched{};  // by edges: these have pixels of their own, and the line may change after them
  Blocks lit{};  // by pixels behind stop patterns
  std::array<std::array<double, kLine>, TileGrid::kHeight> carried{};  // by row: the line left of the first column
  CoverageSums cover;

  [[nodiscard]] bool is_carried() const { return x0 > 0; }  // whether it receives what edges to its left changed
  [[nodiscard]] int blocks() const { return (width + kBlock - 1) / kBlock; }
  // The change of the line after a block.
  [[nodiscard]] double* change_after(int row, int block) {
    return storage_->changes.data() + kLine * static_cast<std::size_t>(row * kMaxBlocks + block);
  }
  [[nodiscard]] double* pixels_at(int row) {
    return storage_->pixels.data() + kPixel * kPixelPitch * static_cast<std::size_t>(row);
  }
  // Marks the blocks from first to last, including last.
  void touch(int row, int first, int last) {
    const std::uint64_t to_last = ~std::uint64_t{0} >> static_cast<unsigned>(63 - last);
    touched[static_cast<std::size_t>(row)] |= to_last & (~std::uint64_t{0} << static_cast<unsigned>(first));
  }
  // Light that is added to single pixels. Floats are enough, as nothing is subtracted from it.
  void make_light() {
    if (light_ == nullptr) light_ = std::make_unique<Light>();
  }
  [[nodiscard]] float* light_at(int row) {
    return light_->values.data() + kPixel * kPixelPitch * static_cast<std::size_t>(row);
  }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(TileSums) + sizeof(Storage) + (light_ ? sizeof(Light) : 0) + cover.bytes();
  }
  // groups: a bit for each kBlock columns from `first` on.
  void light_groups(int row, int first, std::uint64_t groups) {
    groups <<= static_cast<unsigned>(first / kBlock);
    lit[static_cast<std::size_t>(row)] |= first % kBlock == 0 ? groups : groups | groups << 1U;
  }

 private:
  // The pitch is no power of two, so that rows do not compete for cache lines. Groups that begin within a block end
  // beyond the last one.
  static constexpr std::size_t kPixelPitch = TileGrid::kWidth + 24;
  struct alignas(64) Storage {
    std::array<double, kLine * kMaxBlocks * TileGrid::kHeight> changes{};
    std::array<double, kPixel * kPixelPitch * TileGrid::kHeight + 1> pixels{};  // with one unused
  };
  struct alignas(64) Light {
    std::array<float, kPixel * kPixelPitch * TileGrid::kHeight> values{};
  };
  std::unique_ptr<Storage> storage_ = std::make_unique<Storage>();
  std::unique_ptr<Light> light_;  // made with the first polygon behind a stop pattern
};

}  // namespace contrejour::inline internal::adaptive
