// SPDX-License-Identifier: Apache-2.0
// The buffers and the parameters of the shaders that draw grids. The parameters are those of src/vulkan/layout.h.
#include "buffers.glsl"
#include "counts.glsl"

layout(push_constant) uniform Parameters {
  uint reals_at, integers_at, step_count, first_ray;
  uint side, crossing_count, bound_count, flags;
  int width, height;
  float triangle_weight;  // flux of half a cell of transmission 1
  uint level;
  float gain[3];          // from flux to fixed-point sums
  float merge_threshold;
  uint blocks_at, level_side, finer_at, finer_side;
  uint large_capacity, corner_capacity;
}
p;

#define FLAG_SMOOTH 2u      // the irradiance is linear over a cell
#define FLAG_LAST_LEVEL 4u  // cells are merged no further
#define FLAG_OBSCURED 8u    // something within the lens blocks light
#define FLAG_METHOD_SHIFT 4u  // interpolation in a quadrilateral, as TiledOptions::Interpolation
