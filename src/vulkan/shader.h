// SPDX-License-Identifier: Apache-2.0
// The shaders, compiled from the folder shaders when the library is built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "optics/trace/packet_trace.h"

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
  ListSizes,
  Bin,
  BinWide,
  PlaceLists,
  AdaptiveSearch,
  AdaptiveMeasure,
  AdaptiveBudget,
  AdaptiveTrace,
  AdaptiveVertices,
  AdaptiveCells,
  AdaptiveCut,
  AdaptiveCutSize,
  AdaptiveRaster,
  AdaptiveRasterPatterned,
  AdaptiveJoinParts,
  // The same as those without the word, for frames with dirt.
  AdaptiveMeasureOccluded,
  AdaptiveCellsOccluded,
  AdaptiveCutOccluded,
  AdaptiveRasterOccluded,
  StarburstFar,
  StarburstNear,
  Rgba,
};
inline constexpr std::size_t kShaders = 32;

// A shader, and what it must handle, so that drivers leave out the code of all else: for those that trace rays the
// surfaces, for those of `adaptive` whether the iris is a picture.
struct Program {
  Program(Shader which, PathGeometry surfaces = PathGeometry::General) : shader(which), geometry(surfaces) {}

  Shader shader;
  PathGeometry geometry;
  bool has_picture = false;
};
inline constexpr std::size_t kPrograms = 6 * kShaders;
[[nodiscard]] inline std::size_t number_of(Program program) {
  return 6 * static_cast<std::size_t>(program.shader) + 2 * static_cast<std::size_t>(program.geometry) +
         (program.has_picture ? 1 : 0);
}

[[nodiscard]] std::span<const std::uint32_t> code_of(Shader shader);

}  // namespace contrejour::inline internal::vulkan
