// SPDX-License-Identifier: Apache-2.0
// The shaders of tiles share this: the polygons of a tile, and the sums of a pixel, in fixed point, so that their order
// does not matter.
#include "sums.glsl"
#include "lists/record.glsl"
#include "lists/task.glsl"

uint pixel_sums[6];

float word_float(uint word) { return uintBitsToFloat(large[word]); }
bool contains(uint polygon, ivec2 pixel) {
  ivec4 box = box_of(polygon);
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x <= box.z && pixel.y <= box.w;
}

ivec2 begin_tile(Task task) {
  for (int k = 0; k < 6; ++k) pixel_sums[k] = 0u;
  return 8 * task.tile + ivec2(gl_LocalInvocationID.xy);
}

// gain_word: of the first of three gains.
void add_to_pixel(float flux, uint gain_word) {
  for (uint c = 0u; c < 3u; ++c) {
    uvec2 value = to_fixed(flux * word_float(gain_word + c));
    uint carry;
    pixel_sums[2u * c] = uaddCarry(pixel_sums[2u * c], value.x, carry);
    pixel_sums[2u * c + 1u] += value.y + carry;
  }
}

// Other tasks may add to the same pixel.
void end_tile(ivec2 pixel) {
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  uint at = 6u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  for (uint c = 0u; c < 3u; ++c) add_fixed(at + 2u * c, uvec2(pixel_sums[2u * c], pixel_sums[2u * c + 1u]));
}
