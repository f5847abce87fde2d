// SPDX-License-Identifier: Apache-2.0
// Draws the polygons of a tile, one tile a workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define READ_TEXELS
#include "common.glsl"
// Processors draw many pixels an invocation, but for stop patterns, whose loops may take too many turns.
#ifdef PATTERNS
layout(local_size_x = 256) in;
#define BY_COLUMN false
#else
layout(local_size_x_id = 4) in;  // 256, or 32 by columns
#define BY_COLUMN ON_PROCESSOR
#endif
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
#define FOUR_CORNERS BY_COLUMN
#include "listed_polygon.glsl"
#include "tile_sums.glsl"

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

// Whether a polygon covers a square of pixels. low: its corner from the polygon's base.
bool covers(Polygon q, vec2 low, float side) {
  uint first = first_of(q), count = count_of(q);
  if (count < 3u) return false;
#ifdef PATTERNS
  if (pattern_of(q) != 0u) return false;
#endif
  float half_side = 0.5 * side;
  vec2 before = large_corner(first + count - 1u) - low - half_side;
  for (uint k = 0u; k < count; ++k) {
    vec2 here = large_corner(first + k) - low - half_side, along = here - before;
    if (along.y * before.x - along.x * before.y < half_side * (abs(along.x) + abs(along.y))) return false;
    before = here;
  }
  return true;
}

// Adds a polygon that covers the tile, or a quarter of it, to a plane, which each pixel evaluates once.
void add_plane(uint plane, Polygon q, vec2 origin) {
  vec2 gradient = gradient_of(q);
  float value = value_of(q) + dot(gradient, origin + 0.5 - point_of(q));
  vec3 gain = gain_of(q) * fixed_units;
  for (uint c = 0u; c < 3u; ++c) {
    uint at = PLANE_WORDS * plane + 6u * c;
    add_to_plane(at, value * gain[c]);
    add_to_plane(at + 2u, gradient.x * gain[c]);
    add_to_plane(at + 4u, gradient.y * gain[c]);
  }
}

// The polygon of an invocation in a tile.
struct InTile {
  uint number;
  Polygon q;
  ivec4 box;  // within the tile
};

InTile in_tile(uint number) {
  ivec4 whole = box_of(number);
  return InTile(number, polygon_of(number), ivec4(max(whole.xy, tile_low), min(whole.zw, tile_low + TILE_SIDE - 1)));
}

#include "columns.glsl"
#include "prepared.glsl"

// Draws the next polygons of the tile's list: first those of few pixels and of the whole tile, one an invocation, then
// the others.
void draw_some(uint from, uint end, ivec2 at) {
  uint t = gl_LocalInvocationIndex;
  if (t == 0u) others_count = 0u;
  barrier();
  uint k = from + t;
  if (k < end) {
    InTile one = in_tile(texelFetch(list_texels, int(k)).x);
    ivec2 extent = one.box.zw - one.box.xy + 1;
    vec2 origin = vec2(tile_low - base_of(one.q));
    if (extent.x == TILE_SIDE && extent.y == TILE_SIDE && covers(one.q, origin, float(TILE_SIDE)))
      add_plane(0u, one.q, origin);
    else if (extent.x * extent.y <= p.small_px)
      draw_small(one.q, one.box);
    else
      others[atomicAdd(others_count, 1u)] = one.number;
  }
  barrier();
  draw_others(at);
}

// A number of the tile's plane and of that of a pixel's quarter, exactly.
uvec2 plane_word(uint k, ivec2 at) {
  if (!BY_COLUMN) return uvec2(plane_sums[k], plane_sums[k + 1u]);
  uint of_quarter = PLANE_WORDS * uint(1 + at.x / QUARTER_SIDE + 2 * (at.y / QUARTER_SIDE)) + k;
  return add_words(uvec2(plane_sums[k], plane_sums[k + 1u]), uvec2(plane_sums[of_quarter], plane_sums[of_quarter + 1u]));
}

// The sum of all planes at a pixel, exactly, and how much it grows to the next pixel of the column.
struct PlaneSums {
  uvec2 here, by_row;
};

PlaneSums planes_at(uint channel, ivec2 at) {
  uint k = 6u * channel;
  uvec2 by_row = plane_word(k + 4u, at);
  uvec2 by_x = times_words(plane_word(k + 2u, at), uint(at.x)), by_y = times_words(by_row, uint(at.y));
  return PlaneSums(add_words(plane_word(k, at), add_words(by_x, by_y)), by_row);
}

// The pixel's sums of a channel, in fixed point: planes and small polygons.
uvec2 small_sum(uint channel, ivec2 at, PlaneSums planes) {
  uint word = 6u * uint(TILE_SIDE * at.y + at.x) + 2u * channel;
  return add_words(uvec2(tile_sums[word], tile_sums[word + 1u]), planes.here);
}

// Writes a pixel, or adds that of a part of a tile to the tile's sums, which are exact; join_parts.comp turns them into
// pixels.
void finish_pixel(uint split, int row, ivec2 at, PlaneSums planes[3]) {
  ivec2 pixel = tile_low + at;
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  uint to = 3u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  uint part = SPLIT_SUMS + TILE_WORDS * (split - 1u) + 6u * uint(TILE_SIDE * at.y + at.x);
  for (uint c = 0u; c < 3u; ++c) {
    uvec2 rest = small_sum(c, at, planes[c]);
    if (split == 0u) {
      picture[to + c] = (coarse_sum[row][c] + fine_sum[row][c]) + from_fixed(rest.x, rest.y) / fixed_units;
    } else {
      uvec2 sum = add_words(to_fixed(coarse_sum[row][c] * fixed_units), to_fixed(fine_sum[row][c] * fixed_units));
      add_fixed(part + 2u * c, add_words(sum, rest));
    }
  }
}

// Finishes an invocation's pixels: one, or those of its column. Shared memory, which lavapipe reads slowly, is read once
// for a column's planes.
void finish_pixels(uint split, ivec2 at) {
  PlaneSums planes[3];
  for (uint c = 0u; c < 3u; ++c) planes[c] = planes_at(c, at);
  finish_pixel(split, 0, at, planes);
  if (!BY_COLUMN) return;
  [[unroll]] for (int row = 1; row < ROWS; ++row) {
    for (uint c = 0u; c < 3u; ++c) planes[c].here = add_words(planes[c].here, planes[c].by_row);
    finish_pixel(split, row, at + ivec2(0, row), planes);
  }
}

void main() {
  Task task;
  if (!find_task(task)) return;
  tile_low = TILE_SIDE * task.tile;
  uint t = gl_LocalInvocationIndex, invocations = gl_WorkGroupSize.x;
  ivec2 at = ivec2(t % uint(TILE_SIDE), t / uint(TILE_SIDE));
  if (BY_COLUMN) at = low_of_quarter(t / 8u) + ivec2(t % 8u, 0);
  for (uint k = t; k < TILE_WORDS; k += invocations) tile_sums[k] = 0u;
  for (uint k = t; k < 5u * PLANE_WORDS; k += invocations) plane_sums[k] = 0u;
  [[unroll]] for (int row = 0; row < ROWS; ++row) coarse_sum[row] = fine_sum[row] = vec3(0.0);
  begin_sums();
  barrier();
  uint from = task.from;
  if (BY_COLUMN) {
    from = draw_by_columns(from, task.end);
  } else {
    for (; from < task.end; from += invocations) draw_some(from, task.end, at);
  }
  check_end(from, task.end);
  finish_pixels(task.split, at);
}
