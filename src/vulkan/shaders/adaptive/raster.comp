// SPDX-License-Identifier: Apache-2.0
// Draws the polygons of a tile, one tile a workgroup. Sums are exact, so that the order of the lists changes no bit: those
// of small polygons are integers; the values of others are split into multiples of a coarse and of a fine unit.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
#define READ_TEXELS
#include "common.glsl"
#include "../lists/record.glsl"
#include "../lists/task.glsl"
#include "../coverage.glsl"
#include "../sums.glsl"
#include "parts.glsl"
#ifdef PATTERNS
#include "../iris.glsl"
#include "../stop/pattern.glsl"
#ifdef OCCLUDERS
#include "../stop/occluders.glsl"
#endif
#endif

// Edges are taken in fours rather than in loops: lavapipe ends all loops of an invocation after 65535 turns in all, so
// that the last polygons of crowded tiles would be missing.

shared uint tile_sums[TILE_WORDS];
shared uint plane_sums[18];  // of polygons that cover the tile: value at the first pixel, slopes, by channel
shared uint others[256];
shared uint others_count;
// The polygons that are prepared.
shared vec4 edges[256];
shared uint edge_counts[32];  // 0: not prepared
shared ivec4 boxes_of_polygons[32];
shared vec3 gains[32], planes[32];
float fixed_units;  // a unit of pixel value
ivec2 tile_low;     // its first pixel

vec3 coarse_sum = vec3(0.0), fine_sum = vec3(0.0);
float coarse_shift, fine_shift;  // 1.5 * 2^23 units: adding one rounds to a whole number of units

void begin_sums() {
  float peak = frame_peak();
  float coarse_unit = exp2(ceil(log2(peak)) - 8.0);  // sums of up to 65536 peaks are exact
  coarse_shift = coarse_unit * 12582912.0;
  fine_shift = coarse_shift * 6.103515625e-5;  // 2^-14: sums of the rests of 2048 polygons are exact
  fixed_units = units_of(peak);
}

void add_to_plane(uint at, float value) {
  uvec2 number = to_fixed(value);
  uint before = atomicAdd(plane_sums[at], number.x);
  uint high = number.y + (before > ~number.x ? 1u : 0u);
  if (high != 0u) atomicAdd(plane_sums[at + 1u], high);
}

void add_to_tile(uint at, float value) {
  uvec2 number = to_fixed(value);
  uint before = atomicAdd(tile_sums[at], number.x);
  uint high = number.y + (before > ~number.x ? 1u : 0u);
  if (high != 0u) atomicAdd(tile_sums[at + 1u], high);
}

void add(float flux, vec3 gain) {
  precise vec3 value = flux * gain;
  precise vec3 coarse = (value + coarse_shift) - coarse_shift;
  precise vec3 rest = value - coarse;
  precise vec3 fine = (rest + fine_shift) - fine_shift;
  coarse_sum += coarse;
  fine_sum += fine;
}

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
  for (uint k = 4u; k < count; k += 4u) {
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
#define POLYGON_MAP_CORNERS 12u
#else
#define POLYGON_MAP_CORNERS 3u
#endif
shared uint patterns_of_polygons[32];  // or masks
shared vec2 maps[32u * POLYGON_MAP_CORNERS];  // of the pixels of the tile
shared uint edge_bits_of_polygons[32];

#ifdef OCCLUDERS
shared uint pattern_words[32];  // a pattern's number, and that of the last crossing

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

// The same of a prepared polygon.
float prepared_product_at(uint j, vec2 place, float size) {
  uint mask = patterns_of_polygons[j], pattern = pattern_words[j], last = pattern >> LAST_SHIFT;
  uint map = POLYGON_MAP_CORNERS * j;
  float all = 1.0;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(mask, k, last)) continue;
    vec2 x = maps[map], y = maps[map + 1u], at = maps[map + 2u] + x * place.x + y * place.y;
    all *= transmittance_of_point(mask, k, last, pattern & ~(3u << LAST_SHIFT), edge_bits_of_polygons[j], at, size * x,
                                  size * y);
    map += 3u;
  }
  return all;
}

float prepared_transmittance(uint j, vec2 place) {
  partly_covering = 0u;
  float sum = 0.0;
  for (int k = WHOLE_PIXEL; k < PARTS_OF_PIXEL * PARTS_OF_PIXEL; ++k) {
    float one = prepared_product_at(j, place + part_of_pixel(k), width_of_part(k));
    if (k == WHOLE_PIXEL && !is_seen_in_parts()) return one;
    if (k != WHOLE_PIXEL) sum += one;
  }
  return sum / float(PARTS_OF_PIXEL * PARTS_OF_PIXEL);
}

// Prepares the maps of a polygon, which begin at a corner.
void prepare_maps(uint j, uint first, vec2 middle) {
  edge_bits_of_polygons[j] = floatBitsToUint(large_corner(first).x);
  pattern_words[j] = floatBitsToUint(large_corner(first).y);
  uint mask = patterns_of_polygons[j], from = first + 1u, to = POLYGON_MAP_CORNERS * j;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(mask, k, pattern_words[j] >> LAST_SHIFT)) continue;
    vec2 x = large_corner(from), y = large_corner(from + 1u);
    maps[to] = x;
    maps[to + 1u] = y;
    maps[to + 2u] = large_corner(from + 2u) + x * middle.x + y * middle.y;
    from += 3u;
    to += 3u;
  }
}
#else
float transmittance_of(Polygon q, vec2 corner) {
  uint pattern = pattern_of(q), map = map_of(q);
  if (pattern == 0u) return 1.0;
  vec2 x = large_corner(map), y = large_corner(map + 1u), middle = corner + 0.5;
  return transmittance_at(pattern, large_corner(map + 2u) + x * middle.x + y * middle.y, x, y,
                          floatBitsToUint(large_corner(map + 3u).x));
}

float prepared_transmittance(uint j, vec2 place) {
  vec2 x = maps[3u * j], y = maps[3u * j + 1u];
  return transmittance_at(patterns_of_polygons[j], maps[3u * j + 2u] + x * place.x + y * place.y, x, y,
                          edge_bits_of_polygons[j]);
}

void prepare_maps(uint j, uint first, vec2 middle) {
  vec2 x = large_corner(first), y = large_corner(first + 1u);
  edge_bits_of_polygons[j] = floatBitsToUint(large_corner(first + 3u).x);
  maps[3u * j] = x;
  maps[3u * j + 1u] = y;
  maps[3u * j + 2u] = large_corner(first + 2u) + x * middle.x + y * middle.y;
}
#endif
#else
uint count_of(Polygon q) { return q.corners.y; }
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

// Polygons of few pixels: an invocation draws one by itself, into sums of the tile in fixed point. One loop over all
// pixels, as lavapipe's invocations wait for each other at the end of each row.
void draw_small(Polygon q, ivec4 box) {
  vec3 gain = gain_of(q) * fixed_units;
  Corners corners = corners_from(first_of(q), count_of(q));
  vec2 last = last_corner(q);
  for (ivec2 at = box.xy; at.y <= box.w; at = at.x < box.z ? ivec2(at.x + 1, at.y) : ivec2(box.x, at.y + 1)) {
    float value = value_at(q, corners, last, at);
    if (value == 0.0) continue;
    uint sum = 6u * uint((at.y - tile_low.y) * TILE_SIDE + at.x - tile_low.x);
    for (uint c = 0u; c < 3u; ++c) add_to_tile(sum + 2u * c, value * gain[c]);
  }
}

// Prepares polygons for drawing by pixel: 8 invocations a polygon, an edge each.
void prepare(uint from, uint count) {
  uint t = gl_LocalInvocationIndex, j = t / 8u, e = t % 8u;
  if (from + j >= count) return;
  uint number = others[from + j];
  Polygon q = polygon_of(number);
  uint first = first_of(q), corners = count_of(q);
  vec2 origin = vec2(tile_low - base_of(q));
  bool is_convex = corners >= 3u && corners <= 8u;
  if (e >= corners) edges[t] = vec4(0.0, 0.0, 1.0, 0.0);  // every pixel is inside
  if (is_convex && e < corners) {
    vec2 a = large_corner(first + e) - origin, b = large_corner(first + (e + 1u == corners ? 0u : e + 1u)) - origin;
    vec2 along = b - a;
    // For the middle of the tile's pixel (x, y): positive inside, above w where the whole pixel is.
    edges[t] = vec4(-along.y, along.x, along.x * (0.5 - a.y) - along.y * (0.5 - a.x), 0.5 * (abs(along.x) + abs(along.y)));
  }
  if (e != 0u) return;
  edge_counts[j] = is_convex ? corners : 0u;
  boxes_of_polygons[j] = box_of(number) - tile_low.xyxy;
  gains[j] = gain_of(q);
  planes[j] = vec3(gradient_of(q), value_of(q) + dot(gradient_of(q), origin + 0.5 - point_of(q)));
#ifdef PATTERNS
  patterns_of_polygons[j] = pattern_of(q);
  if (patterns_of_polygons[j] != 0u) prepare_maps(j, first + corners, origin + 0.5);
#endif
}

// How a pixel lies to the edges of a polygon: outside one, or across some, and the last of these.
struct Crossing {
  bool is_outside;
  uint count;
  vec3 edge;
};

void cross_edge(vec4 edge, vec2 place, inout Crossing crossing) {
  float side = dot(edge.xy, place) + edge.z;
  if (side <= -edge.w) crossing.is_outside = true;
  if (side >= edge.w) return;
  ++crossing.count;
  crossing.edge = vec3(edge.xy, side);
}

void cross_four_edges(uint first, vec2 place, inout Crossing crossing) {
  cross_edge(edges[first], place, crossing);
  cross_edge(edges[first + 1u], place, crossing);
  cross_edge(edges[first + 2u], place, crossing);
  cross_edge(edges[first + 3u], place, crossing);
}

// The value of a prepared polygon in a pixel of the tile.
float prepared_value(uint j, uint polygon, ivec2 at, ivec2 pixel) {
  ivec4 box = boxes_of_polygons[j];
  if (at.x < box.x || at.y < box.y || at.x > box.z || at.y > box.w) return 0.0;
  uint count = edge_counts[j];
  if (count == 0u) return value_at(polygon, pixel);
  vec2 place = vec2(at);
  Crossing crossing = Crossing(false, 0u, vec3(0.0));
  cross_four_edges(8u * j, place, crossing);
  if (count > 4u) cross_four_edges(8u * j + 4u, place, crossing);
  if (crossing.is_outside) return 0.0;
  if (crossing.count > 1u) return value_at(polygon, pixel);
  float covered = crossing.count == 0u ? 1.0 : half_plane(crossing.edge.xy, crossing.edge.z);
#ifdef PATTERNS
  if (patterns_of_polygons[j] != 0u) covered *= prepared_transmittance(j, place);
#endif
  return covered * (dot(planes[j].xy, place) + planes[j].z);
}

// Whether a polygon covers the whole tile.
bool covers_tile(Polygon q, vec2 origin) {
  uint first = first_of(q), count = count_of(q);
  if (count < 3u) return false;
#ifdef PATTERNS
  if (pattern_of(q) != 0u) return false;
#endif
  const float half_tile = 0.5 * float(TILE_SIDE);
  vec2 before = large_corner(first + count - 1u) - origin - half_tile;
  for (uint k = 0u; k < count; ++k) {
    vec2 here = large_corner(first + k) - origin - half_tile, along = here - before;
    if (along.y * before.x - along.x * before.y < half_tile * (abs(along.x) + abs(along.y))) return false;
    before = here;
  }
  return true;
}

// Adds a polygon that covers the tile to the tile's plane, which each pixel evaluates once.
void draw_whole(Polygon q, vec2 origin) {
  vec2 gradient = gradient_of(q);
  float value = value_of(q) + dot(gradient, origin + 0.5 - point_of(q));
  vec3 gain = gain_of(q) * fixed_units;
  for (uint c = 0u; c < 3u; ++c) {
    add_to_plane(6u * c, value * gain[c]);
    add_to_plane(6u * c + 2u, gradient.x * gain[c]);
    add_to_plane(6u * c + 4u, gradient.y * gain[c]);
  }
}

float plane_at(uint channel, vec2 at) {
  float value = from_fixed(plane_sums[6u * channel], plane_sums[6u * channel + 1u]);
  float by_x = from_fixed(plane_sums[6u * channel + 2u], plane_sums[6u * channel + 3u]);
  float by_y = from_fixed(plane_sums[6u * channel + 4u], plane_sums[6u * channel + 5u]);
  return value + by_x * at.x + by_y * at.y;
}

// Draws the next polygons of the tile's list: first those of few pixels and of the whole tile, one an invocation, then
// the others, one pixel an invocation.
void draw_some(uint from, uint end, ivec2 pixel) {
  if (gl_LocalInvocationIndex == 0u) others_count = 0u;
  barrier();
  uint k = from + gl_LocalInvocationIndex;
  if (k < end) {
    uint number = texelFetch(list_texels, int(k)).x;
    Polygon q = polygon_of(number);
    ivec4 whole = box_of(number), box = ivec4(max(whole.xy, tile_low), min(whole.zw, tile_low + TILE_SIDE - 1));
    ivec2 extent = box.zw - box.xy + 1;
    vec2 origin = vec2(tile_low - base_of(q));
    if (extent.x == TILE_SIDE && extent.y == TILE_SIDE && covers_tile(q, origin))
      draw_whole(q, origin);
    else if (extent.x * extent.y <= p.small_px)
      draw_small(q, box);
    else
      others[atomicAdd(others_count, 1u)] = number;
  }
  barrier();
  uint count = others_count;
  for (uint chunk = 0u; chunk < count; chunk += 32u) {
    prepare(chunk, count);
    barrier();
    uint j = 0u, prepared = min(32u, count - chunk);
    for (; j < prepared; ++j) {
      float value = prepared_value(j, others[chunk + j], ivec2(gl_LocalInvocationID.xy), pixel);
      if (value != 0.0) add(value, gains[j]);
    }
    check_end(j, prepared);
    barrier();
  }
}

// The tile's plane at a pixel, exactly.
uvec2 plane_words(uint channel, uvec2 at) {
  uint k = 6u * channel;
  uvec2 by_x = times_words(uvec2(plane_sums[k + 2u], plane_sums[k + 3u]), at.x);
  uvec2 by_y = times_words(uvec2(plane_sums[k + 4u], plane_sums[k + 5u]), at.y);
  return add_words(uvec2(plane_sums[k], plane_sums[k + 1u]), add_words(by_x, by_y));
}

// Adds a part of a tile to the tile's sums, which are exact; join_parts.comp turns them into pixels.
void add_part(uint split) {
  uint t = gl_LocalInvocationIndex, at = SPLIT_SUMS + TILE_WORDS * (split - 1u) + 6u * t;
  for (uint c = 0u; c < 3u; ++c) {
    uvec2 sum = add_words(to_fixed(coarse_sum[c] * fixed_units), to_fixed(fine_sum[c] * fixed_units));
    sum = add_words(sum, uvec2(tile_sums[6u * t + 2u * c], tile_sums[6u * t + 2u * c + 1u]));
    add_fixed(at + 2u * c, add_words(sum, plane_words(c, gl_LocalInvocationID.xy)));
  }
}

void write_pixel(ivec2 pixel) {
  uint t = gl_LocalInvocationIndex, at = 3u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  for (uint c = 0u; c < 3u; ++c)
    picture[at + c] = (coarse_sum[c] + fine_sum[c]) +
                      (from_fixed(tile_sums[6u * t + 2u * c], tile_sums[6u * t + 2u * c + 1u]) +
                       plane_at(c, vec2(gl_LocalInvocationID.xy))) /
                          fixed_units;
}

void main() {
  Task task;
  if (!find_task(task)) return;
  tile_low = TILE_SIDE * task.tile;
  ivec2 pixel = tile_low + ivec2(gl_LocalInvocationID.xy);
  uint t = gl_LocalInvocationIndex;
  for (uint k = t; k < TILE_WORDS; k += 256u) tile_sums[k] = 0u;
  if (t < 18u) plane_sums[t] = 0u;
  begin_sums();
  barrier();
  uint from = task.from;
  for (; from < task.end; from += 256u) draw_some(from, task.end, pixel);
  check_end(from, task.end);
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  if (task.split == 0u)
    write_pixel(pixel);
  else
    add_part(task.split);
}
