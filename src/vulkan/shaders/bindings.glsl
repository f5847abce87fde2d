// SPDX-License-Identifier: Apache-2.0
// The buffers and the parameters of the shaders that draw grids. The parameters are those of src/vulkan/layout.h.
#define READ_TEXELS
#include "buffers.glsl"
#include "counts.glsl"

layout(push_constant) uniform Parameters {
  uint step_count, first_ray;
  uint side, crossing_count, bound_count, flags;
  int width, height;
  float triangle_weight;  // of trace.comp: flux of half a cell of transmission 1, in units of the sums
  uint level;
  float gain[3];          // of resolve.comp: from fixed-point sums to pixel values
  float merge_threshold;
  uint blocks_at, level_side, finer_at, finer_side;
  uint large_capacity, corner_capacity;
  uint primitive_capacity;
  uint grid_count;    // grids of a dispatch, which have the same parameters and lie one after the other
  uint block_stride;  // from one grid's blocks to the next one's
  int large_pixels;  // of the bounds from which on a polygon is listed
  uint first_grid;  // number of the dispatch's first grid
  uint picture;     // as the iris: its pattern's number, of which the next one is its distances; 0: none
}
p;

// The bits of the things that block a ray, as a whole number in vertices[].y: a rim, or the iris at the first crossing
// and so on.
#define BLOCKED_BY_RIM 1u
#define BLOCKED_BY_IRIS 2u
uint blockers_of(vec2 vertex) { return uint(vertex.y); }

#define FLAG_SMOOTH 2u      // the irradiance is linear over a cell
#define FLAG_LAST_LEVEL 4u  // cells are merged no further
#define FLAG_OBSCURED 8u    // something within the lens blocks light
#define FLAG_FIRST 1u       // of resolve.comp: what the picture was does not count
