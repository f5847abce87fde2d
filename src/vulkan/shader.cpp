// SPDX-License-Identifier: Apache-2.0
#include "vulkan/shader.h"

namespace contrejour::inline internal::vulkan {
namespace {

#include "vulkan/blocks.inc"
#include "vulkan/cells.inc"
#include "vulkan/large_cells.inc"
#include "vulkan/large_primitives.inc"
#include "vulkan/primitives.inc"
#include "vulkan/resolve.inc"
#include "vulkan/trace.inc"
#include "vulkan/trace_double.inc"
#include "vulkan/vertices.inc"
#include "vulkan/widen.inc"

}  // namespace

std::span<const std::uint32_t> code_of(Shader shader) {
  switch (shader) {
    case Shader::TraceFloat: return kTraceCode;
    case Shader::TraceDouble: return kTraceDoubleCode;
    case Shader::Cells: return kCellsCode;
    case Shader::LargeCells: return kLargeCellsCode;
    case Shader::Resolve: return kResolveCode;
    case Shader::Widen: return kWidenCode;
    case Shader::Blocks: return kBlocksCode;
    case Shader::Primitives: return kPrimitivesCode;
    case Shader::LargePrimitives: return kLargePrimitivesCode;
    case Shader::Vertices: return kVerticesCode;
  }
  return {};
}

}  // namespace contrejour::inline internal::vulkan
