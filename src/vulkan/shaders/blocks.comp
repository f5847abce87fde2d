// SPDX-License-Identifier: Apache-2.0
// Finds which cells, or with MERGED blocks of cells, are one primitive, a level of merging a dispatch:
// PrimitiveBuilder::find_cells() and merge(). blocks[]: a block's flux if it is whole; BLOCK_DARK or BLOCK_PARTED if
// not.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "quad.glsl"

#define BLOCK_DARK -1.0
#define BLOCK_PARTED -2.0

uint own_grid;
#ifdef DIMMED
#include "iris.glsl"
#include "coverage.glsl"
#include "grid_stop.glsl"

// Whether a picture as the iris may let some light of a cell pass: RayGrid::slack().
bool is_lit(uvec4 v) {
  float slack = 0.0, least = FAILED;
  for (uint c = 0u; c < p.crossing_count; ++c)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) slack = max(slack, 0.5 * length(crossing(v[i], c) - crossing(v[j], c)));
  for (int i = 0; i < 4; ++i) {
    float most = ray_of(v[i]).w - 1.0;
    for (uint c = 0u; c < p.crossing_count; ++c) most = max(most, distance_from_picture(crossing(v[i], c)));
    least = min(least, most);
  }
  return least <= slack;
}
#endif

float cell_value(uint ix, uint iy) {
  uvec4 v = corners_of(1u, ix, iy);
  bool lit = passes(v.x) || passes(v.y) || passes(v.z) || passes(v.w);
#ifdef DIMMED
  if (HAS_PICTURE) {
    set_grid(p.first_grid + own_grid);
    if (grid_pattern == 0u) lit = is_lit(v);
  }
#endif
  if (!lit) return BLOCK_DARK;
  if (any_failed(v) || !is_convex(v)) return BLOCK_PARTED;
  return 1.0 / 3.0 * (2.0 * (ray_of(v.x).z + ray_of(v.z).z) + ray_of(v.y).z + ray_of(v.w).z);
}

bool same(vec2 difference) { return abs(difference.x) + abs(difference.y) < p.merge_threshold; }

// bodonyi2023 eq. 11 and 12, as PrimitiveBuilder::is_flat().
bool is_flat(uint ix, uint iy) {
  uint half_size = (1u << p.level) / 2u;
  vec2 q[9];
  for (uint k = 0u; k < 9u; ++k)
    q[k] = ray_of(ray_at((2u * ix + k % 3u) * half_size, (2u * iy + k / 3u) * half_size)).xy;
  for (int k = 0; k < 3; ++k) {
    if (!same(q[3 * k] - 2.0 * q[3 * k + 1] + q[3 * k + 2])) return false;
    if (!same(q[k] - 2.0 * q[k + 3] + q[k + 6])) return false;
  }
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      int k = 3 * row + column;
      if (!same((q[k + 1] - q[k]) - (q[k + 4] - q[k + 3]))) return false;
    }
  }
  return true;
}

bool is_open(uint ix, uint iy) {
  uint half_size = (1u << p.level) / 2u;
  for (uint k = 0u; k < 9u; ++k)
    if (ray_of(ray_at((2u * ix + k % 3u) * half_size, (2u * iy + k / 3u) * half_size)).w > 1.0) return false;
  return true;
}

float merged_value(uint ix, uint iy) {
  float flux = 0.0;
  for (uint k = 0u; k < 4u; ++k) {
    float part = blocks[p.finer_at + own_grid * p.block_stride + (2u * iy + k / 2u) * p.finer_side + 2u * ix + k % 2u];
    if (part < 0.0) return BLOCK_PARTED;
    flux += part;
  }
  if (!is_flat(ix, iy) || !is_convex(corners_of(1u << p.level, ix, iy))) return BLOCK_PARTED;
  if ((p.flags & FLAG_OBSCURED) != 0u && !is_open(ix, iy)) return BLOCK_PARTED;
  return flux;
}

void main() {
  uint k = linear_invocation(), count = p.level_side * p.level_side;
  if (k >= p.grid_count * count) return;
  own_grid = k / count;
  first_ray = p.first_ray + own_grid * p.side * p.side;
  k -= own_grid * count;
  uint ix = k % p.level_side, iy = k / p.level_side;
  uint at = p.blocks_at + own_grid * p.block_stride + k;
#ifdef MERGED
  blocks[at] = merged_value(ix, iy);
#else
  blocks[at] = cell_value(ix, iy);
#endif
}
