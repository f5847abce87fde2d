// SPDX-License-Identifier: Apache-2.0
// Gives each tile its part of the lists and its tasks, one tile an invocation. The parts' order does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "parameters.glsl"

void make_tasks(uint tile, uint first, uint count) {
  uint parts = max((count + p.list_part - 1u) / p.list_part, 1u), slot = 0u;
  if (parts > 1u) slot = 1u + atomicAdd(counters[COUNT_SPLIT], 1u);
  uint place = (tile % p.tiles_across) | (tile / p.tiles_across) << 16u;
  uint at = atomicAdd(counters[COUNT_TASKS], parts);
  for (uint k = 0u; k < parts; ++k) {
    uint from = k * p.list_part, end = min(count, from + p.list_part);
    tile_tasks[at + k] = uvec4(place, first + from, first + end, 2u * slot + (k == 0u ? 1u : 0u));
  }
}

void main() {
  uint tile = linear_invocation();
  if (tile >= p.tiles_across * p.tiles_down) return;
  uint count = tile_counts[2u * tile];
  uint first = count == 0u ? 0u : atomicAdd(counters[COUNT_LISTED], count);
  tile_first[tile] = first;
  if (first + count <= p.list_capacity) {
    make_tasks(tile, first, count);
    return;
  }
  atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_LISTS);
  atomicMax(counters[COUNT_MOST_LISTED], first + count);
}
