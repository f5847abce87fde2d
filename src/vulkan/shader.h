// SPDX-License-Identifier: Apache-2.0
// The shaders, compiled from shaders/*.comp and shaders/adaptive/*.comp when the library is built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace contrejour::inline internal::vulkan {

enum class Shader : std::uint8_t {
  TraceFloat,
  TraceDouble,
  Cells,
  LargeCells,
  Resolve,
  Widen,
  Blocks,
  Primitives,
  LargePrimitives,
  Vertices,
  AdaptiveSearch,
  AdaptiveMeasure,
  AdaptiveBudget,
  AdaptiveTrace,
  AdaptiveVertices,
  AdaptiveCells,
  AdaptiveCut,
  AdaptiveSizes,
  AdaptiveBin,
  AdaptiveBinWide,
  AdaptiveTiles,
  AdaptiveRaster,
  AdaptiveRasterPatterned,
};
inline constexpr std::size_t kShaders = 23;

[[nodiscard]] std::span<const std::uint32_t> code_of(Shader shader);

}  // namespace contrejour::inline internal::vulkan
