// SPDX-License-Identifier: Apache-2.0
// A polygon that cells.comp, merge.comp or cut.comp have listed, and its value in a pixel. Its edges are taken in fours
// rather than in loops: lavapipe ends all loops of an invocation after 65535 turns in all, so that the last polygons of
// crowded tiles would be missing. Whoever includes this file defines FOUR_CORNERS: whether value_at() meets no polygons of
// more.

// The part of a line that lies in a pixel.
float part_in_pixel(vec2 from, vec2 to) {
  vec2 by = to - from;
  float first = 0.0, last = 1.0;
  for (int k = 0; k < 2; ++k) {
    if (by[k] == 0.0) {
      if (from[k] < 0.0 || from[k] >= 1.0) return 0.0;
      continue;
    }
    float a = -from[k] / by[k], b = (1.0 - from[k]) / by[k];
    first = max(first, min(a, b));
    last = min(last, max(a, b));
  }
  return max(last - first, 0.0);
}

// The record of a polygon. Its words are described in list.glsl.
struct Polygon {
  uvec4 density, point_and_gain, corners;
};

Polygon polygon_of(uint number) {
  return Polygon(large_quarter(4u * number), large_quarter(4u * number + 1u), large_quarter(4u * number + 2u));
}
float value_of(Polygon q) { return uintBitsToFloat(q.density.x); }
vec2 gradient_of(Polygon q) { return uintBitsToFloat(q.density.yz); }
vec2 point_of(Polygon q) { return vec2(uintBitsToFloat(q.density.w), uintBitsToFloat(q.point_and_gain.x)); }
vec3 gain_of(Polygon q) { return uintBitsToFloat(q.point_and_gain.yzw); }
uint first_of(Polygon q) { return q.corners.x; }
bool is_concave(Polygon q) { return (q.corners.y & CONCAVE) != 0u; }
ivec2 base_of(Polygon q) { return ivec2(q.corners.zw); }

// Four corners from a place in large_corners on; past the last one, this again.
struct Corners {
  vec2 a, b, c, d;
};
Corners corners_from(uint first, uint count) {
  uint last = first + count - 1u;
  return Corners(large_corner(first), large_corner(min(first + 1u, last)), large_corner(min(first + 2u, last)),
                 large_corner(min(first + 3u, last)));
}

// The areas to the right of the edges from a point to four corners, one after the other.
float area_right_of_four(vec2 before, Corners q, vec2 pixel) {
  vec2 a = q.a - pixel, b = q.b - pixel, c = q.c - pixel, d = q.d - pixel;
  return area_right_of(before - pixel, a) + area_right_of(a, b) + area_right_of(b, c) + area_right_of(c, d);
}

// The part of a pixel that a polygon covers, exactly. corners: the first four; last: the last one.
float covered_part(uint first, uint count, Corners corners, vec2 last, vec2 pixel) {
  float covered = area_right_of_four(last, corners, pixel);
  vec2 before = corners.d;
  for (uint k = 4u; !FOUR_CORNERS && k < count; k += 4u) {
    Corners more = corners_from(first + k, count - k);
    covered += area_right_of_four(before, more, pixel);
    before = more.d;
  }
  return max(-covered, 0.0);
}

// Only frames with stop patterns have polygons with them, whose numbers are in the high bits.
#ifdef PATTERNS
uint count_of(Polygon q) { return q.corners.y & CORNERS_MASK; }
uint pattern_of(Polygon q) { return q.corners.y >> PATTERN_SHIFT; }  // or its mask
uint map_of(Polygon q) { return first_of(q) + count_of(q); }  // where its maps begin in large_corners

#ifdef OCCLUDERS
// The product of a polygon's transmittances at a place in the picture, over a part of a pixel's sides. map: where its
// first map begins in large_corners.
float product_at(uint mask, uint map, uint pattern, uint edge_bits, vec2 place, float size) {
  uint last = pattern >> LAST_SHIFT;
  float all = 1.0;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(mask, k, last)) continue;
    vec2 x = large_corner(map), y = large_corner(map + 1u), at = large_corner(map + 2u) + x * place.x + y * place.y;
    all *= transmittance_of_point(mask, k, last, pattern & ~(3u << LAST_SHIFT), edge_bits, at, size * x, size * y);
    map += 3u;
  }
  return all;
}

// A polygon's transmittance in a pixel.
float transmittance_of(Polygon q, vec2 corner) {
  uint mask = pattern_of(q), map = map_of(q);
  if (mask == 0u) return 1.0;
  uint edge_bits = floatBitsToUint(large_corner(map).x), pattern = floatBitsToUint(large_corner(map).y);
  vec2 middle = corner + 0.5;
  partly_covering = 0u;
  float sum = 0.0;
  for (int k = WHOLE_PIXEL; k < PARTS_OF_PIXEL * PARTS_OF_PIXEL; ++k) {
    float one = product_at(mask, map + 1u, pattern, edge_bits, middle + part_of_pixel(k), width_of_part(k));
    if (k == WHOLE_PIXEL && !is_seen_in_parts()) return one;
    if (k != WHOLE_PIXEL) sum += one;
  }
  return sum / float(PARTS_OF_PIXEL * PARTS_OF_PIXEL);
}
#else
float transmittance_of(Polygon q, vec2 corner) {
  uint pattern = pattern_of(q), map = map_of(q);
  if (pattern == 0u) return 1.0;
  vec2 x = large_corner(map), y = large_corner(map + 1u), middle = corner + 0.5;
  return transmittance_at(pattern, large_corner(map + 2u) + x * middle.x + y * middle.y, x, y,
                          floatBitsToUint(large_corner(map + 3u).x));
}
#endif
#else
uint count_of(Polygon q) { return q.corners.y & CORNERS_MASK; }
#endif

// The polygon's value in a pixel. corners, last: as for covered_part().
float value_at(Polygon q, Corners corners, vec2 last, ivec2 pixel) {
  uint count = count_of(q);
  vec2 corner = vec2(pixel - base_of(q));
  if (count == 1u) return value_of(q);
  if (count == 2u) return value_of(q) * part_in_pixel(corners.a - corner, corners.b - corner);
  float covered = covered_part(first_of(q), count, corners, last, corner);
  if (covered == 0.0) return 0.0;
#ifdef PATTERNS
  covered *= transmittance_of(q, corner);
#endif
  return covered * (value_of(q) + dot(gradient_of(q), corner + 0.5 - point_of(q)));
}

vec2 last_corner(Polygon q) { return large_corner(first_of(q) + count_of(q) - 1u); }

float value_at(uint number, ivec2 pixel) {
  Polygon q = polygon_of(number);
  return value_at(q, corners_from(first_of(q), count_of(q)), last_corner(q), pixel);
}
