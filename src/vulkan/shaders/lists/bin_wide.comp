// SPDX-License-Identifier: Apache-2.0
// Counts or lists the polygons of many tiles, as bin.comp: one polygon a workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "parameters.glsl"
#include "record.glsl"
#include "reach.glsl"

void main() {
  uint own = linear_group();
  if (own >= counters[COUNT_WIDE]) return;
  uint polygon = wide[own];
  ivec4 tiles = tiles_of(polygon);
  for (int k = int(gl_LocalInvocationIndex); k < tiles.z * tiles.w; k += 64) {
    if (!may_reach(polygon, tiles, k)) continue;
    uint tile = tile_number(tiles, k), at = atomicAdd(tile_counts[2u * tile + p.level], 1u);
    if (p.level == 0u) continue;
    uint place = tile_first[tile] + at;
    if (place < p.list_capacity) tile_lists[place] = polygon;
  }
}
