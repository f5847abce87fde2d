// SPDX-License-Identifier: Apache-2.0
// Lists the quadrilaterals of the cells that are open and smooth, one cell an invocation. The others, which take long,
// are listed for cut.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "../polygon.glsl"
#include "../cell.glsl"
#include "bent_image.glsl"
#include "list.glsl"
#include "side_bend.glsl"
#ifdef OCCLUDERS
#include "../coverage.glsl"
#endif
#include "state.glsl"
#include "merged.glsl"

// As bend_of_side(), of a side of the cell that begins at a place in the grid.
vec4 bend_of_side(uvec2 at, uvec2 along, vec4 first, vec4 second) {
  uvec2 before = at - min(at, along), after = min(at + 2u * along, uvec2(side - 1u));
  vec4 a = ray_of(ray_at(before.x, before.y)), d = ray_of(ray_at(after.x, after.y));
  bvec2 exist = bvec2(before != at && !failed(a), after != at + along && !failed(d));
  return bend_of_side(vec4[4](a, first, second, d), exist);
}

// The mean, over an open cell, of what its light bends from the linear, as the rays around show: coatings transmit
// light that is far from linear over a coarse cell. Sets the bulges of its sides.
float light_bend(uvec4 v, out Bulges bulges) {
  uvec2 at = uvec2(own % side, own / side);
  vec4 a = ray_of(v.x), b = ray_of(v.y), c = ray_of(v.z), d = ray_of(v.w);
  vec4 below = bend_of_side(at, uvec2(1u, 0u), a, b), above = bend_of_side(at + uvec2(0u, 1u), uvec2(1u, 0u), d, c);
  vec4 left = bend_of_side(at, uvec2(0u, 1u), a, d), right = bend_of_side(at + uvec2(1u, 0u), uvec2(0u, 1u), b, c);
  bulges = Bulges(0.0, vec2(0.0));
  add_bulge(bulges, pixel_of(v.x), pixel_of(v.y), mean_distance_of(below.xy));
  add_bulge(bulges, pixel_of(v.y), pixel_of(v.z), mean_distance_of(right.xy));
  add_bulge(bulges, pixel_of(v.z), pixel_of(v.w), mean_distance_of(above.xy));
  add_bulge(bulges, pixel_of(v.w), pixel_of(v.x), mean_distance_of(left.xy));
  return -(below.z + right.z + above.z + left.z) / 24.0;
}

float light_of(uvec4 v) { return 0.25 * (ray_of(v.x).z + ray_of(v.y).z + ray_of(v.z).z + ray_of(v.w).z); }

// Returns false where the cell's triangles are to be drawn in its place.
bool list_open(uvec4 v) {
  vec2 a = pixel_of(v.x), b = pixel_of(v.y), c = pixel_of(v.z), d = pixel_of(v.w);
  Bulges bulges;
  float flux = 2.0 * triangle_weight * max(light_of(v) + light_bend(v, bulges), 0.0);
  if (floor(a) == floor(b) && floor(a) == floor(c) && floor(a) == floor(d)) {
    list_point(a, flux);
    return true;
  }
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  float area = 0.5 * cross2(c - a, d - b);
  if (!all(greaterThan(e, vec4(0.0))) || !is_convex(a, b, c, d, area)) return false;
  bool shaded = is_shaded(area, e);
  if (!shaded) bulges = Bulges(0.0, vec2(0.0));
  vec2 gradient = shaded ? gradient_of(v, e) : vec2(0.0);
  list_quad(a, b, c, d, density_of(flux, area, centroid_of(a, b, c, d), bulges, gradient));
  return true;
}

// Parts at edges are no smaller than half a pixel, and those of folds than a pixel. Edges have a point between their
// ends, but only smaller parts follow the folds of open cells.
uint cut_parts(uvec4 v, bool is_open) {
  vec2 low = min(min(ray_of(v.x).xy, ray_of(v.y).xy), min(ray_of(v.z).xy, ray_of(v.w).xy));
  vec2 high = max(max(ray_of(v.x).xy, ray_of(v.y).xy), max(ray_of(v.z).xy, ray_of(v.w).xy));
  uint most = uint(min((is_open ? 1.0 : 2.0) * max(high.x - low.x, high.y - low.y) + 1.0, float(MOST_CUT_PARTS)));
  uint parts = floatBitsToUint(state(item, STATE_PARTS)) * (is_open ? MOST_CUT_PARTS / MOST_EDGE_PARTS : 1u);
  return clamp(parts, 1u, most);
}

void list_cut(uint parts) {
  uint at = atomicAdd(counters[COUNT_CUT], parts * parts);
  if (at + parts * parts > p.cut_capacity) {
    atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_CUT);
    return;
  }
  for (uint k = 0u; k < parts * parts; ++k)
    cut_cells[at + k] = uvec2(item, own | (k << CUT_PART_SHIFT) | ((parts - 1u) << CUT_PARTS_SHIFT));
}

// Whether merge.comp has drawn the cell.
bool is_merged() {
  uvec2 at = uvec2(own % side, own / side), block = at / BLOCK_CELLS, half_block = at / (BLOCK_CELLS / 2u) & 1u;
  if (max(block.x, block.y) >= blocks_a_side(side)) return false;
  uint number = BLOCKS_OF_RAYS * offset_of(item) + block.y * blocks_a_side(side) + block.x;
  uint mask = uint(texelFetch(block_texels, int(number)).x);
  return (mask & (WHOLE_BLOCK | 1u << (2u * half_block.y + half_block.x))) != 0u;
}

void main() {
  if (!find_ray() || own % side + 1u == side || own / side + 1u == side) return;
#ifndef OCCLUDERS
  if (is_merged()) return;
#endif
#ifdef OCCLUDERS
  grid_box = state_box(item);
#endif
  uvec4 v = first_ray + own + uvec4(0u, 1u, side + 1u, side);
  int how = patterned_state(v, crossings_of(item), pattern_of(item));
  if (how == STATE_CLOSED) return;
  bool any_failed = failed(ray_of(v.x)) || failed(ray_of(v.y)) || failed(ray_of(v.z)) || failed(ray_of(v.w));
  if (!any_failed && outside_frame(v)) return;
  set_cell(v);
#ifdef OCCLUDERS
  // An open cell with occluders is drawn by cut.comp, but whole: its sides are as straight as those of others.
  int region = any_failed ? REGION_VARYING : region_of_picture(v.x, v.y, v.z, v.w, crossings_of(item));
  if (region == REGION_DARK) return;
  if (how == STATE_OPEN && (region == REGION_VARYING || is_dirty(v.x, v.y, v.z, v.w, crossings_of(item)))) {
    list_cut(1u);
    return;
  }
#endif
  if (how == STATE_OPEN && list_open(v)) return;
  list_cut(any_failed ? 1u : cut_parts(v, how == STATE_OPEN));
}
