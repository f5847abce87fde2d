// SPDX-License-Identifier: Apache-2.0
// The buffers of shaders, by the numbers of their bindings. All shaders share one layout.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vulkan/raii.h"

namespace contrejour::inline internal::vulkan {

// In the order of their bindings (shaders/bindings.glsl).
enum class Slot : std::uint8_t {
  Floats,
  Integers,
  Tables,
  Rays,
  Crossings,
  Sums,
  Counters,
  Picture,
  Bounds,
  Large,
  LargeCorners,
  Blocks,
  Doubles,
  Vertices,
  Items,
  Found,
  States,
  CutCells,
  TileCounts,
  TileFirst,
  TileLists,
  Indirect,
  Starts,
  Wide,
  Patterns,
  TileTasks,
  Dirt,
  Starbursts,
};
inline constexpr std::size_t kSlots = 28;

// Slots that shaders also read as texels; their bindings follow the slots'.
struct TexelSlot {
  Slot slot;
  vk::Format format;
  std::uint32_t bytes;  // of a texel
};
inline constexpr std::array kTexelSlots{TexelSlot{Slot::Tables, vk::Format::eR32G32Sfloat, 8},
                                        TexelSlot{Slot::Rays, vk::Format::eR32G32B32A32Sfloat, 16},
                                        TexelSlot{Slot::Crossings, vk::Format::eR32G32Sfloat, 8},
                                        TexelSlot{Slot::Vertices, vk::Format::eR32G32Sfloat, 8},
                                        TexelSlot{Slot::Bounds, vk::Format::eR32G32B32A32Sfloat, 16},
                                        TexelSlot{Slot::Large, vk::Format::eR32G32B32A32Uint, 16},
                                        TexelSlot{Slot::LargeCorners, vk::Format::eR32G32Sfloat, 8},
                                        TexelSlot{Slot::TileLists, vk::Format::eR32Uint, 4},
                                        TexelSlot{Slot::Blocks, vk::Format::eR32Sfloat, 4},
                                        TexelSlot{Slot::Floats, vk::Format::eR32G32B32A32Sfloat, 16},
                                        TexelSlot{Slot::Integers, vk::Format::eR32G32B32A32Sint, 16},
                                        TexelSlot{Slot::Items, vk::Format::eR32G32B32A32Uint, 16},
                                        TexelSlot{Slot::Starts, vk::Format::eR32G32B32A32Sfloat, 16},
                                        TexelSlot{Slot::States, vk::Format::eR32G32B32A32Sfloat, 16},
                                        TexelSlot{Slot::Found, vk::Format::eR32G32B32A32Uint, 16},
                                        TexelSlot{Slot::CutCells, vk::Format::eR32G32Uint, 8}};
// Every device lets a stage read 16 (maxPerStageDescriptorSampledImages).
static_assert(kTexelSlots.size() <= 16);
// Slots that trace.comp reads as uniform buffers, from a grid's path on.
inline constexpr std::array kPathSlots{Slot::Floats, Slot::Doubles, Slot::Integers};
inline constexpr std::uint32_t kPushedBytes = 128;  // of parameters: what every device has

}  // namespace contrejour::inline internal::vulkan
