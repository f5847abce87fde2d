// SPDX-License-Identifier: Apache-2.0
// Lists of the polygons that reach each tile of the picture, made on the device from the polygons in Slot::Large. Long
// lists are split into parts: a task is a tile and a part of its list, and a workgroup of a shader that draws tiles
// takes one.
#pragma once

#include <algorithm>
#include <cstdint>

#include "vulkan/device_context.h"

namespace contrejour::inline internal::vulkan {

enum ListFlags : std::uint32_t { kListPrimitives = 1 };

// The shaders' push constants, in their order.
struct TileLists {
  static constexpr std::uint32_t kMostOfTask = 1024;

  std::uint32_t level = 0, flags = 0;  // level: of the present dispatch
  std::uint32_t tiles_across = 0, tiles_down = 0;
  std::uint32_t polygon_capacity = 0, entry_capacity = 0;
  std::int32_t tile_side = 1;  // pixels
  std::uint32_t list_part = kMostOfTask;  // polygons of a task, at most

  [[nodiscard]] std::uint64_t tile_count() const { return std::uint64_t{tiles_across} * tiles_down; }
  [[nodiscard]] std::uint64_t most_split_tiles() const { return std::min(tile_count(), most_tasks() - tile_count()); }
  [[nodiscard]] std::uint64_t most_tasks() const { return tile_count() + entry_capacity / list_part + 1; }
};

// The lists of a picture's tiles; the caller sets flags and capacities.
[[nodiscard]] TileLists tile_lists_of(std::int32_t width, std::int32_t height, std::int32_t tile_side);
void need_buffers(DeviceContext& device, const TileLists& lists);
// Makes the lists empty; their counters are the caller's.
void clear_lists(DeviceContext& device, const TileLists& lists);
// Lists the polygons that were counted, and sets the size of the dispatch kIndirectTiles, a workgroup a task. Where
// capacities do not suffice, Counter::kOverflows says so.
void fill_lists(DeviceContext& device, const DeviceInfo& info, TileLists lists);

}  // namespace contrejour::inline internal::vulkan
