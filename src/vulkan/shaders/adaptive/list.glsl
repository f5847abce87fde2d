// SPDX-License-Identifier: Apache-2.0
// Lists what is to be drawn: polygons of three corners and more, whose shoelace area is positive, lines of two, points of
// one. Words of a record, in
// `large`: the density at a point, its gradient, the point (both 0 for lines and points, whose value is their flux, for
// a line by length); the gains; the first corner and their number, with the stop pattern's in the high bits; the base;
// the bounds, first and last column and row.
// A polygon with a stop pattern has four more corners: how far the stop point moves with a pixel across and down, the
// stop point at the base's upper corner, and the bits of the edges that have fringes in it.
// In frames with occluders (occluders.glsl) the high bits are a mask. If it is not 0, the next corner has the bits of
// the edges, and the pattern's number with that of the last crossing in the highest bits. A map of three corners
// follows for each point that the mask needs.
#include "../lists/record_words.glsl"
#ifdef OCCLUDERS
#define MOST_MAP_CORNERS 13u
#else
#define MOST_MAP_CORNERS 4u
#endif

float triangle_weight;  // flux of half a cell of transmission 1
vec3 gain;
float triangle_flux(uvec3 t) { return triangle_weight * (ray_of(t.x).z + ray_of(t.y).z + ray_of(t.z).z) / 3.0; }

// The frame's pixels within bounds, as (first, last); false if there are none. The bounds are clamped before they are
// converted: a ghost may be far larger than an integer.
bool pixels_of(vec2 low, vec2 high, out ivec4 box) {
  vec2 frame_low = -vec2(base), frame_high = vec2(p.width, p.height) - vec2(base);
  if (!(high.x >= frame_low.x && low.x < frame_high.x && high.y >= frame_low.y && low.y < frame_high.y)) return false;
  ivec2 first = ivec2(floor(max(low, frame_low))), last = ivec2(ceil(min(high, frame_high))) - 1;
  last = min(max(last, first), ivec2(frame_high) - 1);
  box = ivec4(first, last);
  return last.x >= first.x && last.y >= first.y;
}

uint record_pattern = 0u;  // of the polygon to be listed, or its mask; 0: none
bool is_concave = false;   // the polygon to be listed
uint map_corners = 4u;
vec2 pattern_map[MOST_MAP_CORNERS];

// Returns the first corner's place; corners are written by the caller. OVERFLOW: -1.
int begin_record(Density density, uint count, ivec4 box) {
  uint at = atomicAdd(counters[COUNT_POLYGONS], 1u);
  uint corners = record_pattern == 0u ? count : count + map_corners;
  uint first = atomicAdd(counters[COUNT_CORNERS], corners);
  if (at >= p.large_capacity || first + corners > p.corner_capacity) {
    atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_POLYGONS);
    return -1;
  }
  uint word = RECORD_WORDS * at;
  large[word] = floatBitsToUint(density.value);
  large[word + 1u] = floatBitsToUint(density.gradient.x);
  large[word + 2u] = floatBitsToUint(density.gradient.y);
  large[word + 3u] = floatBitsToUint(density.point.x);
  large[word + 4u] = floatBitsToUint(density.point.y);
  for (uint c = 0u; c < 3u; ++c) large[word + 5u + c] = floatBitsToUint(gain[c]);
  large[word + 8u] = first;
  large[word + 9u] = count | (is_concave ? CONCAVE : 0u) | (record_pattern << PATTERN_SHIFT);
  large[word + 10u] = uint(base.x);
  large[word + 11u] = uint(base.y);
  box += base.xyxy;
  for (uint k = 0u; k < 4u; ++k) large[word + 12u + k] = uint(box[k]);
  for (uint k = count; k < corners; ++k) large_corners[first + k] = pattern_map[k - count];
  return int(first);
}

void list_quad(vec2 a, vec2 b, vec2 c, vec2 d, Density density) {
  if (cross2(c - a, d - b) < 0.0) {
    vec2 swapped = b;
    b = d;
    d = swapped;
  }
  ivec4 box;
  if (!pixels_of(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)), box)) return;
  int first = begin_record(density, 4u, box);
  if (first < 0) return;
  large_corners[first] = a;
  large_corners[first + 1] = b;
  large_corners[first + 2] = c;
  large_corners[first + 3] = d;
}

void list_point(vec2 at, float flux) {
  ivec4 box;
  if (!pixels_of(at, at, box)) return;
  box = ivec4(ivec2(floor(at)), ivec2(floor(at)));
  int first = begin_record(Density(vec2(0.0), flux, vec2(0.0)), 1u, box);
  if (first >= 0) large_corners[first] = at;
}

// Whether the polygon is not convex.
bool turns_both_ways() {
  bool left = false, right = false;
  vec2 a = polygon[corner_count - 1], along = a - polygon[corner_count - 2];
  for (int k = 0; k < corner_count; ++k) {
    vec2 next = polygon[k] - a;
    float turn = cross2(along, next);
    left = left || turn > 0.0;
    right = right || turn < 0.0;
    along = next;
    a = polygon[k];
  }
  return left && right;
}

// Lists a point, a line between two points, or else the polygon, within bounds. At one place for all three, since
// lavapipe executes the code of all.
void list_any(bool is_point, bool is_line, vec2 from, vec2 to, Density density, vec2 low, vec2 high) {
  bool is_polygon = !is_point && !is_line;
  vec2 first_point = is_point ? polygon[0] : from, last_point = is_point ? polygon[0] : to;
  ivec4 box;
  if (!pixels_of(is_polygon ? low : min(first_point, last_point), is_polygon ? high : max(first_point, last_point), box))
    return;
  if (is_point) box = ivec4(floor(first_point), floor(first_point));
  int count = is_polygon ? corner_count : is_point ? 1 : 2;
  is_concave = is_polygon && turns_both_ways();
  int first = begin_record(density, uint(count), box);
  if (first < 0) return;
  bool is_reversed = twice_polygon_area() < 0.0;
  for (int k = 0; k < count; ++k) {
    vec2 corner = polygon[is_reversed ? count - 1 - k : k];
    large_corners[first + k] = is_polygon ? corner : k == 0 ? first_point : last_point;
  }
}
