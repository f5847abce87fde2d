// SPDX-License-Identifier: Apache-2.0
// The light of polygons of cells.comp and cut_cells.comp: those of many pixels are listed, and drawn by tile
// (large_cells.comp). Included after cell.glsl and light.glsl.
#define NOT_LISTED 0xffffffffu
#ifdef DIMMED
#include "seen_triangle.glsl"
uvec3 seen_triangle = uvec3(0u);  // of the polygon that is listed
#endif

// Lists a polygon without its corners. Returns where these begin, which are to be in the order that makes the shoelace
// area positive. If memory does not suffice, the host draws the frame again in smaller parts.
uint list_large(Density density, ivec4 box, uint corners) {
  uint at = atomicAdd(counters[COUNT_POLYGONS], 1u);
  uint first = atomicAdd(counters[COUNT_CORNERS], corners);
  if (at >= p.large_capacity || first + corners > p.corner_capacity) {
    atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_POLYGONS);
    return NOT_LISTED;
  }
  uint word = 16u * at;
  large[word] = floatBitsToUint(density.value);
  large[word + 1u] = floatBitsToUint(density.gradient.x);
  large[word + 2u] = floatBitsToUint(density.gradient.y);
  large[word + 3u] = floatBitsToUint(density.point.x);
  large[word + 4u] = floatBitsToUint(density.point.y);
  large[word + 8u] = first;
  large[word + 9u] = corners;
  large[word + 10u] = uint(base.x);
  large[word + 11u] = uint(base.y);
#ifdef DIMMED
  for (uint k = 0u; k < 3u; ++k) large[word + 5u + k] = seen_triangle[k];
#endif
  for (uint k = 0u; k < 4u; ++k) large[word + 12u + k] = uint(box[k] + base[k % 2u]);
  return first;
}

// The frame's pixels within bounds, as (first, last); false if there are none. The bounds are clamped before they are
// converted: a ghost may be far larger than an integer.
bool pixels_of(vec2 low, vec2 high, out ivec4 box) {
  vec2 frame_low = -vec2(base), frame_high = vec2(p.width, p.height) - vec2(base);
  if (!(high.x > frame_low.x && low.x < frame_high.x && high.y > frame_low.y && low.y < frame_high.y)) return false;
  ivec2 first = ivec2(floor(max(low, frame_low))), last = ivec2(ceil(min(high, frame_high))) - 1;
  last = min(max(last, first), ivec2(frame_high) - 1);
  box = ivec4(first, last);
  return last.x >= first.x && last.y >= first.y;
}

bool is_large(ivec4 box) { return (box.z - box.x + 1) * (box.w - box.y + 1) >= p.large_pixels; }

float level_at(Density density, ivec2 at) {
  return density.value + dot(density.gradient, vec2(at) + 0.5 - density.point);
}
