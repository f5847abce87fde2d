// SPDX-License-Identifier: Apache-2.0
// The shaders, compiled from the folder shaders when the library is built.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "contrejour/method_options.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal::vulkan {

enum class Shader : std::uint8_t {
  TraceFloat,
  TraceDouble,
  Cells,
  CutCells,
  LargeCells,
  Resolve,
  Widen,
  Blocks,
  MergedBlocks,
  Primitives,
  OpenPrimitives,
  CutPrimitives,
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
  AdaptiveMerge,
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
  // The same as those without the word, for frames with stop patterns, dirt or a picture as the iris.
  CellsDimmed,
  CutCellsDimmed,
  LargeCellsDimmed,
  BlocksDimmed,
  PrimitivesDimmed,
  CutPrimitivesDimmed,
  LargePrimitivesDimmed,
  // As TraceFloat and TraceDouble, for a picture as the iris.
  TracePictureFloat,
  TracePictureDouble,
};
inline constexpr std::size_t kShaders = 46;

// A shader, and what it must handle, so that drivers leave out the code of all else: for those that trace rays the
// surfaces, for those of `adaptive` whether the iris is a picture, for those of `tiled` the interpolation.
struct Program {
  Program(Shader which, PathGeometry surfaces = PathGeometry::General) : shader(which), geometry(surfaces) {}
  Program(Shader which, TiledOptions::Interpolation method)
      : shader(which), interpolation(method), interpolates(true) {}

  Shader shader;
  PathGeometry geometry = PathGeometry::General;
  TiledOptions::Interpolation interpolation = TiledOptions::Interpolation::LoopDeRose;
  bool interpolates = false;
  bool has_picture = false;
  bool has_patterns = true;  // of the stop, in `adaptive`
};
inline constexpr std::size_t kVariants = 20;  // of a shader
inline constexpr std::size_t kPrograms = kVariants * kShaders;
[[nodiscard]] inline std::size_t number_of(Program program) {
  const auto kind = program.interpolates ? static_cast<std::size_t>(program.interpolation)
                                         : static_cast<std::size_t>(program.geometry);
  return kVariants * static_cast<std::size_t>(program.shader) + 4 * kind + (program.has_picture ? 2 : 0) +
         (program.has_patterns ? 1 : 0);
}

[[nodiscard]] std::span<const std::uint32_t> code_of(Shader shader);

}  // namespace contrejour::inline internal::vulkan
