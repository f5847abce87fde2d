// SPDX-License-Identifier: Apache-2.0
// Stop patterns and dirt as shaders read them (shaders/stop), for all methods.
#pragma once

#include <cstdint>

namespace contrejour::inline internal::vulkan {

// Bits of the flags, besides kCircle.
enum StopFlags : std::uint32_t { kDirtInStop = 16, kDirtOnFront = 32, kHalfTones = 64, kDirtBySquares = 128 };

// A pattern of the stop, as shaders/stop/pattern.glsl reads it.
struct PatternRecord {
  std::uint32_t table_at = 0, side = 0, levels = 0;
  float outer_radius = 0, scale = 0, level_from = 0, roughness = 0, difference = 0, uniform_from = 0;
};
static_assert(sizeof(PatternRecord) == 36);

// The header of the dirt, as shaders/stop/dirt.glsl reads it; the tables begin at these words.
struct DirtHeader {
  float extent_mm = 0;
  std::uint32_t cells = 0;
  float mm_a_unit = 0, edges_per_mm = 0;
  std::uint32_t strokes_at = 0, first_at = 0, of_cell_at = 0, blocked_at = 0, dirty_at = 0;
  std::uint32_t picture_at = 0, picture_width = 0, picture_height = 0;  // picture_at: 0 if there is none
  float clear_radius_mm = 0;
};
static_assert(sizeof(DirtHeader) == 52);

}  // namespace contrejour::inline internal::vulkan
