// SPDX-License-Identifier: Apache-2.0
#include "vulkan/tile_lists.h"

#include "vulkan/counters.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::uint64_t kTaskBytes = 16;

}  // namespace

TileLists tile_lists_of(std::int32_t width, std::int32_t height, std::int32_t tile_side) {
  const auto tiles_in = [&](std::int32_t pixels) {
    return static_cast<std::uint32_t>((pixels + tile_side - 1) / tile_side);
  };
  TileLists lists;
  lists.tiles_across = tiles_in(width);
  lists.tiles_down = tiles_in(height);
  lists.tile_side = tile_side;
  return lists;
}

void need_buffers(DeviceContext& device, const TileLists& lists) {
  device.need(Slot::TileCounts, 2 * sizeof(std::uint32_t) * lists.tile_count());
  device.need(Slot::TileFirst, sizeof(std::uint32_t) * lists.tile_count());
  device.need(Slot::TileLists, sizeof(std::uint32_t) * lists.entry_capacity);
  device.need(Slot::Wide, sizeof(std::uint32_t) * lists.polygon_capacity);
  device.need(Slot::TileTasks, kTaskBytes * lists.most_tasks());
  device.need(Slot::Indirect, kIndirectBytes);
}

void clear_lists(DeviceContext& device, const TileLists& lists) {
  device.clear(Slot::TileCounts, 0, 2 * sizeof(std::uint32_t) * lists.tile_count());
}

void fill_lists(DeviceContext& device, const DeviceInfo& info, TileLists lists) {
  const auto dispatch_at = [&](std::uint32_t level, Shader shader, GroupCount groups) {
    lists.level = level;
    device.dispatch(shader, lists, groups);
    device.barrier();
  };
  const auto visit_polygons = [&](std::uint32_t level) {
    lists.level = level;
    device.dispatch_indirect(Shader::Bin, lists, kIndirectPolygons);
    device.barrier();
    if (level == 0) dispatch_at(1, Shader::ListSizes, {1, 1});
    lists.level = level;
    device.dispatch_indirect(Shader::BinWide, lists, kIndirectWide);
    device.barrier();
  };
  dispatch_at(0, Shader::ListSizes, {1, 1});
  visit_polygons(0);
  dispatch_at(0, Shader::PlaceLists, groups_of(lists.tile_count(), info));
  dispatch_at(2, Shader::ListSizes, {1, 1});
  visit_polygons(1);
}

}  // namespace contrejour::inline internal::vulkan
