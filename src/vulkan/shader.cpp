// SPDX-License-Identifier: Apache-2.0
#include "vulkan/shader.h"

namespace contrejour::inline internal::vulkan {
namespace {

#include "vulkan/adaptive_budget.inc"
#include "vulkan/adaptive_cells.inc"
#include "vulkan/adaptive_cells_occluded.inc"
#include "vulkan/adaptive_cut.inc"
#include "vulkan/adaptive_cut_occluded.inc"
#include "vulkan/adaptive_cut_size.inc"
#include "vulkan/adaptive_join_parts.inc"
#include "vulkan/adaptive_measure.inc"
#include "vulkan/adaptive_measure_occluded.inc"
#include "vulkan/adaptive_merge.inc"
#include "vulkan/adaptive_raster.inc"
#include "vulkan/adaptive_raster_occluded.inc"
#include "vulkan/adaptive_raster_patterned.inc"
#include "vulkan/adaptive_search.inc"
#include "vulkan/adaptive_trace.inc"
#include "vulkan/adaptive_vertices.inc"
#include "vulkan/bin.inc"
#include "vulkan/bin_wide.inc"
#include "vulkan/blocks.inc"
#include "vulkan/blocks_dimmed.inc"
#include "vulkan/cells.inc"
#include "vulkan/cells_dimmed.inc"
#include "vulkan/cut_cells.inc"
#include "vulkan/cut_cells_dimmed.inc"
#include "vulkan/cut_primitives.inc"
#include "vulkan/cut_primitives_dimmed.inc"
#include "vulkan/large_cells.inc"
#include "vulkan/large_cells_dimmed.inc"
#include "vulkan/large_primitives.inc"
#include "vulkan/large_primitives_dimmed.inc"
#include "vulkan/list_sizes.inc"
#include "vulkan/merged_blocks.inc"
#include "vulkan/open_primitives.inc"
#include "vulkan/place_lists.inc"
#include "vulkan/primitives.inc"
#include "vulkan/primitives_dimmed.inc"
#include "vulkan/resolve.inc"
#include "vulkan/rgba.inc"
#include "vulkan/starburst_far.inc"
#include "vulkan/starburst_near.inc"
#include "vulkan/trace.inc"
#include "vulkan/trace_double.inc"
#include "vulkan/trace_picture.inc"
#include "vulkan/trace_picture_double.inc"
#include "vulkan/vertices.inc"
#include "vulkan/widen.inc"

}  // namespace

std::span<const std::uint32_t> code_of(Shader shader) {
  switch (shader) {
    case Shader::TraceFloat: return kTraceCode;
    case Shader::TraceDouble: return kTraceDoubleCode;
    case Shader::Cells: return kCellsCode;
    case Shader::CutCells: return kCutCellsCode;
    case Shader::LargeCells: return kLargeCellsCode;
    case Shader::Resolve: return kResolveCode;
    case Shader::Widen: return kWidenCode;
    case Shader::Blocks: return kBlocksCode;
    case Shader::Primitives: return kPrimitivesCode;
    case Shader::MergedBlocks: return kMergedBlocksCode;
    case Shader::OpenPrimitives: return kOpenPrimitivesCode;
    case Shader::CutPrimitives: return kCutPrimitivesCode;
    case Shader::LargePrimitives: return kLargePrimitivesCode;
    case Shader::Vertices: return kVerticesCode;
    case Shader::ListSizes: return kListSizesCode;
    case Shader::Bin: return kBinCode;
    case Shader::BinWide: return kBinWideCode;
    case Shader::PlaceLists: return kPlaceListsCode;
    case Shader::AdaptiveSearch: return kAdaptiveSearchCode;
    case Shader::AdaptiveMeasure: return kAdaptiveMeasureCode;
    case Shader::AdaptiveBudget: return kAdaptiveBudgetCode;
    case Shader::AdaptiveTrace: return kAdaptiveTraceCode;
    case Shader::AdaptiveVertices: return kAdaptiveVerticesCode;
    case Shader::AdaptiveMerge: return kAdaptiveMergeCode;
    case Shader::AdaptiveCells: return kAdaptiveCellsCode;
    case Shader::AdaptiveCut: return kAdaptiveCutCode;
    case Shader::AdaptiveCutSize: return kAdaptiveCutSizeCode;
    case Shader::AdaptiveRaster: return kAdaptiveRasterCode;
    case Shader::AdaptiveRasterPatterned: return kAdaptiveRasterPatternedCode;
    case Shader::AdaptiveJoinParts: return kAdaptiveJoinPartsCode;
    case Shader::AdaptiveMeasureOccluded: return kAdaptiveMeasureOccludedCode;
    case Shader::AdaptiveCellsOccluded: return kAdaptiveCellsOccludedCode;
    case Shader::AdaptiveCutOccluded: return kAdaptiveCutOccludedCode;
    case Shader::AdaptiveRasterOccluded: return kAdaptiveRasterOccludedCode;
    case Shader::StarburstFar: return kStarburstFarCode;
    case Shader::StarburstNear: return kStarburstNearCode;
    case Shader::Rgba: return kRgbaCode;
    case Shader::CellsDimmed: return kCellsDimmedCode;
    case Shader::CutCellsDimmed: return kCutCellsDimmedCode;
    case Shader::LargeCellsDimmed: return kLargeCellsDimmedCode;
    case Shader::BlocksDimmed: return kBlocksDimmedCode;
    case Shader::PrimitivesDimmed: return kPrimitivesDimmedCode;
    case Shader::CutPrimitivesDimmed: return kCutPrimitivesDimmedCode;
    case Shader::LargePrimitivesDimmed: return kLargePrimitivesDimmedCode;
    case Shader::TracePictureFloat: return kTracePictureCode;
    case Shader::TracePictureDouble: return kTracePictureDoubleCode;
  }
  return {};
}

}  // namespace contrejour::inline internal::vulkan
