// SPDX-License-Identifier: Apache-2.0
// The shaders of tiles share this: the polygons of a tile, and the sum of a pixel, in fixed point, so that its order
// does not matter.
#include "sums.glsl"
#include "lists/record.glsl"
#include "lists/task.glsl"

uvec2 pixel_sum;

bool contains(uint polygon, ivec2 pixel) {
  ivec4 box = box_of(polygon);
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x <= box.z && pixel.y <= box.w;
}

ivec2 begin_tile(Task task) {
  pixel_sum = uvec2(0u);
  return 8 * task.tile + ivec2(gl_LocalInvocationID.xy);
}

void add_to_pixel(float flux) { pixel_sum = add_words(pixel_sum, to_fixed(flux)); }

// Other tasks may add to the same pixel.
void end_tile(ivec2 pixel) {
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  add_fixed(2u * (uint(pixel.y) * uint(p.width) + uint(pixel.x)), pixel_sum);
}
