// SPDX-License-Identifier: Apache-2.0
// The counters of the shaders, and the dispatches whose size they decide, as in shaders/counts.glsl.
#pragma once

#include <cstdint>

namespace contrejour::inline internal::vulkan {

// Words of Slot::Counters.
enum Counter : std::uint32_t {
  kPolygonsListed,
  kCornersListed,
  kTileEntries,
  kWidePolygons,
  kTasks,
  kSplitTiles,
  kOverflows,  // bits: Overflow
  kMostTileEntries,  // the size that lists needed where theirs did not suffice
  kPrimitiveCount,
  kCutCells,
  kRayBlocks,
  kPeakBits,
  kSearchedBlocks,
  kCounters,
};

enum Overflow : std::uint32_t {
  kRaysOverflow = 1,
  kPolygonsOverflow = 2,
  kCutCellsOverflow = 4,
  kListsOverflow = 8,
  kTurnsOverflow = 16,  // a driver that bounds the turns of loops ended one before the end of a tile's list
};

// Bytes of Slot::Indirect.
inline constexpr std::uint64_t kIndirectRays = 0, kIndirectOpen = 0, kIndirectCut = 12, kIndirectPolygons = 24,
                               kIndirectWide = 36, kIndirectTiles = 48, kIndirectMerged = 60, kIndirectBytes = 72;

}  // namespace contrejour::inline internal::vulkan
