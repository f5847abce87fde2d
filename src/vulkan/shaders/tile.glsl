// SPDX-License-Identifier: Apache-2.0
// The shaders of tiles share this: which listed polygons reach a tile, and the sums of a pixel, in fixed point, so that
// their order does not matter. A listed polygon's words 12 to 15 are its first and last column and row.
#include "sums.glsl"
#define TILE_SIDE 8
#define TILE_PIXELS 64u

shared uint reaching_polygons[TILE_PIXELS];
shared uint reaching_count;
uint pixel_sums[6];

float word_float(uint word) { return uintBitsToFloat(large[word]); }
ivec4 box_of(uint word) {
  return ivec4(int(large[word + 12u]), int(large[word + 13u]), int(large[word + 14u]), int(large[word + 15u]));
}
bool contains(uint word, ivec2 pixel) {
  ivec4 box = box_of(word);
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x <= box.z && pixel.y <= box.w;
}

ivec2 begin_tile() {
  for (int k = 0; k < 6; ++k) pixel_sums[k] = 0u;
  return ivec2(gl_GlobalInvocationID.xy);
}

// Collects those of the next polygons that reach the tile. All invocations of a workgroup call it together.
uint find_reaching(uint from, uint count) {
  if (gl_LocalInvocationIndex == 0u) reaching_count = 0u;
  barrier();
  uint at = from + gl_LocalInvocationIndex;
  if (at < count) {
    ivec4 box = box_of(16u * at);
    ivec2 low = ivec2(gl_WorkGroupID.xy) * TILE_SIDE;
    if (box.x < low.x + TILE_SIDE && box.y < low.y + TILE_SIDE && box.z >= low.x && box.w >= low.y)
      reaching_polygons[atomicAdd(reaching_count, 1u)] = at;
  }
  barrier();
  return reaching_count;
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

void end_tile(ivec2 pixel) {
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  uint any = 0u;
  for (int k = 0; k < 6; ++k) any |= pixel_sums[k];
  if (any == 0u) return;
  uint at = 6u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  for (uint c = 0u; c < 3u; ++c) {
    uint carry;
    sums[at + 2u * c] = uaddCarry(sums[at + 2u * c], pixel_sums[2u * c], carry);
    sums[at + 2u * c + 1u] += pixel_sums[2u * c + 1u] + carry;
  }
}
