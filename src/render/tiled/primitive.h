// SPDX-License-Identifier: Apache-2.0
// What bodonyi2023 4.1 calls a primitive: a cell of a ghost's ray grid, or a block of cells merged into one, on the
// frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contrejour/frame.h"

namespace contrejour::inline internal::tiled {

// Pixels of the frame with their middle within a primitive's bounds, both ends included.
struct PixelRange {
  std::int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  [[nodiscard]] bool empty() const { return x1 < x0 || y1 < y0; }
};

// The pixels within the bounds of four corners. The range is also empty if a coordinate is not a number.
[[nodiscard]] PixelRange pixels_within(const std::array<float, 4>& x, const std::array<float, 4>& y,
                                       const Frame& frame);

enum PrimitiveFlags : std::uint16_t {
  kTriangle = 1,  // the fourth corner repeats the first
  kOpen = 2,      // no rim and no crossing of the iris blocks a corner
  kFront = 4,     // points on the front, mm, follow those of the other crossings
};

struct alignas(64) Primitive {
  std::array<float, 4> x, y;        // pixels; corners in order around the cell, the shoelace area positive
  std::array<float, 4> irradiance;  // flux in mm^2 at E0 = 1, per pixel area
  std::array<float, 4> relative_height;
  std::array<float, 4> stop_x, stop_y;  // at the first crossing of the stop
  PixelRange pixels;
  std::uint32_t pass = 0;            // the index of its gain
  std::uint32_t more_crossings = 0;  // index of the first of the other crossings' points
  std::uint16_t crossings = 0;
  std::uint16_t flags = 0;

  [[nodiscard]] std::size_t more_points() const {
    return static_cast<std::size_t>(crossings > 1 ? crossings - 1 : 0) + ((flags & kFront) != 0 ? 1 : 0);
  }
};
static_assert(sizeof(Primitive) == 128);

struct StopPoints {
  std::array<float, 4> x, y;
};

struct PrimitiveBuffer {
  std::vector<Primitive> primitives;
  std::vector<StopPoints> more_crossings;  // second and third crossings, where there are any, and the front

  void clear() {
    primitives.clear();
    more_crossings.clear();
  }
  void append(const Primitive& primitive, const PrimitiveBuffer& from) {
    primitives.push_back(primitive);
    if (primitive.more_points() == 0) return;
    primitives.back().more_crossings = static_cast<std::uint32_t>(more_crossings.size());
    const auto first = from.more_crossings.begin() + static_cast<std::ptrdiff_t>(primitive.more_crossings);
    more_crossings.insert(more_crossings.end(), first, first + static_cast<std::ptrdiff_t>(primitive.more_points()));
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return primitives.size() * sizeof(Primitive) + more_crossings.size() * sizeof(StopPoints);
  }
};

}  // namespace contrejour::inline internal::tiled
