// SPDX-License-Identifier: Apache-2.0
// Gives each tile its part of the lists, one tile an invocation. The parts' order does not matter.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "common.glsl"

void main() {
  uint tile = linear_invocation();
  if (tile >= p.tiles_across * p.tiles_down) return;
  uint count = tile_counts[2u * tile];
  uint first = count == 0u ? 0u : atomicAdd(counters[COUNT_LISTED], count);
  tile_first[tile] = first;
  if (first + count > p.list_capacity) atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_LISTS);
}
