// SPDX-License-Identifier: Apache-2.0
// The parameters of the shaders that list polygons by tile: those of src/vulkan/tile_lists.h.
#define READ_TEXELS
#include "../buffers.glsl"
#include "../counts.glsl"

layout(push_constant) uniform Parameters {
  uint level, flags;
  uint tiles_across, tiles_down;
  uint large_capacity, list_capacity;
  int tile_side;  // pixels
  uint list_part;  // polygons of a task, at most
}
p;

#define LIST_PRIMITIVES 1u  // the corners of a polygon are rays, whose numbers are its first four words
#define WIDE_TILES 32u      // from which on a polygon has a workgroup of its own
