// SPDX-License-Identifier: Apache-2.0
// The parameters and items of the shaders of `adaptive`, as shaders/adaptive/common.glsl reads them.
#pragma once

#include <array>
#include <cstdint>

namespace contrejour::inline internal::vulkan {

// The levels of the search for pupils, in their order; the number of those whose boxes and bounds are kept (LEVELS).
inline constexpr std::uint32_t kScanLevel = 4;  // SCAN_LEVEL
inline constexpr std::array<std::uint32_t, 5> kSearchLevels{0, kScanLevel, 1, 2, 3};
inline constexpr std::uint32_t kSearchLevelsKept = 7;
// search_blocks(): the workgroups of a group.
[[nodiscard]] constexpr std::uint32_t search_blocks(std::uint32_t level, std::uint32_t window_blocks,
                                                    bool is_symmetric) {
  constexpr std::uint32_t kScans = 1, kScansOfLevel = 4;
  const auto blocks = [&](std::uint32_t a_side) { return a_side * (is_symmetric ? (a_side + 1) / 2 : a_side); };
  return level == 0            ? blocks(window_blocks) + kScans
         : level == kScanLevel ? kScansOfLevel
         : level == 1          ? is_symmetric ? 1 + kScans : blocks(2)
                               : 1;
}

// A bit of the flags, besides those of stop_layout.h: FLAG_SYMMETRIC.
inline constexpr std::uint32_t kSymmetric = 256;

// The parameters of a dispatch: the shaders' push constants, in their order.
struct AdaptiveParameters {
  std::uint32_t item_count = 0, group_count = 0, level = 0, flags = 0;
  std::uint32_t bound_count = 0;
  std::int32_t width = 0, height = 0;
  std::uint32_t ray_capacity = 0, large_capacity = 0, corner_capacity = 0, cut_capacity = 0;
  float budget = 0, least_peak = 0, front_gap_mm = 0;
  std::uint32_t picture = 0;  // its number from 1 on; 0: the iris is none
  std::int32_t small_px = 0;
  float merge_error = 0;
  std::uint32_t usual_cells = 0;
  float spot_cells = 0;
  std::uint32_t window_blocks = 0;
};

struct ItemRecord {
  std::uint32_t reals_at = 0, integers_at = 0, step_count = 0, group = 0, crossing_count = 0;
  float irradiance = 0;
  std::array<float, 3> gain{};
  std::array<float, 2> window_mm{};
  std::uint32_t start = 0;
  std::array<float, 2> pixel_origin{};  // of the sensor's middle, with the ghost's displacement
  std::uint32_t pattern = 0;  // its number from 1 on; 0: none
  std::uint32_t unused = 0;
  std::array<float, 3> gain_by_x{}, gain_by_y{};
  std::array<float, 2> middle_mm{};
};
inline constexpr std::size_t kItemWords = 24;  // ITEM_WORDS
using ItemWords = std::array<std::uint32_t, kItemWords>;
static_assert(sizeof(ItemRecord) == sizeof(ItemWords));

struct GroupRecord {
  std::uint32_t first = 0, count = 0, middle = 0, unused = 0;
};
inline constexpr std::size_t kGroupWords = 4;  // a texel
using GroupWords = std::array<std::uint32_t, kGroupWords>;
static_assert(sizeof(GroupRecord) == sizeof(GroupWords));

inline constexpr std::uint64_t kFoundBytes = 48, kStateBytes = 96, kCutBytes = 8, kHistogramBytes = 4096;
inline constexpr std::uint32_t kRaysABlock = 64;
inline constexpr std::uint32_t kMergedOfRays = 4;  // BLOCKS_OF_RAYS

}  // namespace contrejour::inline internal::vulkan
