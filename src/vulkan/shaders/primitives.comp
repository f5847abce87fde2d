// SPDX-License-Identifier: Apache-2.0
// Lists the primitives of a level of merging. Most blocks of the lower levels are parts of others, and would leave
// invocations idle if they were drawn here; triangles, and primitives that a rim or the iris cuts, take far longer than
// others and have a shader of their own.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "quad.glsl"
#define BLOCK_PARTED -2.0

uint own_grid;
#include "primitive_record.glsl"
#ifdef DIMMED
#include "iris.glsl"
#include "coverage.glsl"
#include "grid_stop.glsl"

// Whether nothing but rims and a sharp iris can dim the light of the invocation's grid.
bool is_undimmed() {
  set_grid(p.first_grid + own_grid);
  return grid_pattern == 0u && !HAS_PICTURE && (p.flags & (FLAG_DIRT_IN_STOP | FLAG_DIRT_ON_FRONT)) == 0u;
}
#endif

// Whether the block is a part of a whole block of the next level, whose side is finer_side and place finer_at here.
bool is_merged(uint ix, uint iy) {
  if ((p.flags & FLAG_LAST_LEVEL) != 0u) return false;
  uint jx = ix / 2u, jy = iy / 2u;
  uint at = p.finer_at + own_grid * p.block_stride + jy * p.finer_side + jx;
  return jx < p.finer_side && jy < p.finer_side && block_at(at) >= 0.0;
}

void list(uint ix, uint iy) {
  float value = block_at(p.blocks_at + own_grid * p.block_stride + iy * p.level_side + ix);
  uvec4 v = corners_of(1u << p.level, ix, iy);
  if (p.level == 0u && value == BLOCK_PARTED) {
    vec4 light = vec4(ray_of(v.x).z, ray_of(v.y).z, ray_of(v.z).z, ray_of(v.w).z);
    float first = (light.x + light.y + light.z) / 3.0;
    float second = (light.x + light.z + light.w) / 3.0;
    uint at = atomicAdd(counters[COUNT_CUT], 2u);
    primitives[at] = record_of(v.x, IS_FIRST_TRIANGLE, first);
    primitives[at + 1u] = record_of(v.x, IS_SECOND_TRIANGLE, second);
  }
  if (value < 0.0 || is_merged(ix, iy)) return;
  bool is_open = passes(v.x) && passes(v.y) && passes(v.z) && passes(v.w);
#ifdef DIMMED
  is_open = is_open && is_undimmed();
#endif
  uint at = atomicAdd(counters[is_open ? COUNT_OPEN : COUNT_CUT], 1u);
  primitives[is_open ? open_place(at) : at] = record_of(v.x, IS_QUAD, value);
}

void main() {
  uint k = linear_invocation(), count = p.level_side * p.level_side;
  if (k >= p.grid_count * count) return;
  own_grid = k / count;
  first_ray = p.first_ray + own_grid * p.side * p.side;
  k -= own_grid * count;
  list(k % p.level_side, k / p.level_side);
}
