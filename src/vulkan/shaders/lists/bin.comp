// SPDX-License-Identifier: Apache-2.0
// Counts by tile the polygons whose bounds reach it (level 0), or lists them (level 1). The tiles of a workgroup's 64
// polygons are dealt out evenly to its invocations. Polygons of many tiles are left to bin_wide.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "parameters.glsl"
#include "record.glsl"
#include "reach.glsl"

shared uint tiles_before[64];  // and of the polygon itself
shared ivec4 tile_boxes[64];   // first column and row, columns, rows

void find_tiles(uint polygon, bool exists) {
  uint t = gl_LocalInvocationIndex;
  ivec4 tiles = ivec4(0);
  if (exists) {
    tiles = tiles_of(polygon);
    if (uint(tiles.z * tiles.w) >= WIDE_TILES) {
      if (p.level == 0u) wide[atomicAdd(counters[COUNT_WIDE], 1u)] = polygon;
      tiles = ivec4(0);
    }
  }
  tile_boxes[t] = tiles;
  tiles_before[t] = uint(tiles.z * tiles.w);
  barrier();
  for (uint reach = 1u; reach < 64u; reach *= 2u) {
    uint other = t >= reach ? tiles_before[t - reach] : 0u;
    barrier();
    tiles_before[t] += other;
    barrier();
  }
}

uint polygon_of(uint pair) {
  uint low = 0u, high = 63u;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (tiles_before[middle] > pair)
      high = middle;
    else
      low = middle + 1u;
  }
  return low;
}

shared uint tile_of[64];   // of each invocation's pair; NO_TILE: none
shared uint place_of[64];  // of the first pair of a tile: where its polygons begin in the tile's list
#define NO_TILE 0xffffffffu

// The number of a tile's earlier pairs among the invocations, and of all.
uvec2 rank_in_tile(uint tile) {
  uvec2 rank = uvec2(0u);
  for (uint k = 0u; k < 64u; ++k) {
    if (tile_of[k] != tile) continue;
    rank.y += 1u;
    if (k < gl_LocalInvocationIndex) rank.x += 1u;
  }
  return rank;
}

uint first_with(uint tile) {
  uint k = 0u;
  while (tile_of[k] != tile) ++k;
  return k;
}

// Pairs of 64 invocations; most polygons of a workgroup are neighbours, and one atomic serves all those of a tile.
void bin_pairs(uint first, uint from, uint pairs) {
  uint t = gl_LocalInvocationIndex, pair = from + t, k = 0u;
  tile_of[t] = NO_TILE;
  if (pair < pairs) {
    k = polygon_of(pair);
    int rest = int(pair - (k == 0u ? 0u : tiles_before[k - 1u]));
    if (may_reach(first + k, tile_boxes[k], rest)) tile_of[t] = tile_number(tile_boxes[k], rest);
  }
  barrier();
  uint tile = tile_of[t];
  uvec2 rank = tile == NO_TILE ? uvec2(1u, 0u) : rank_in_tile(tile);
  if (rank.x == 0u) place_of[t] = atomicAdd(tile_counts[2u * tile + p.level], rank.y);
  barrier();
  if (tile != NO_TILE && p.level != 0u) {
    uint place = tile_first[tile] + place_of[first_with(tile)] + rank.x;
    if (place < p.list_capacity) tile_lists[place] = first + k;
  }
  barrier();
}

// Counts or lists one polygon in all its tiles. Processors have no neighbours that wait at one atomic, but read shared
// memory and pass barriers slowly.
void bin_alone(uint polygon) {
  ivec4 tiles = tiles_of(polygon);
  int tile_count = tiles.z * tiles.w;
  if (uint(tile_count) >= WIDE_TILES) {
    if (p.level == 0u) wide[atomicAdd(counters[COUNT_WIDE], 1u)] = polygon;
    return;
  }
  for (int k = 0; k < tile_count; ++k) {
    if (!may_reach(polygon, tiles, k)) continue;
    uint tile = tile_number(tiles, k), place = atomicAdd(tile_counts[2u * tile + p.level], 1u);
    if (p.level == 0u) continue;
    place += tile_first[tile];
    if (place < p.list_capacity) tile_lists[place] = polygon;
  }
}

void main() {
  uint count = min(counters[COUNT_POLYGONS], p.large_capacity);
  uint first = 64u * linear_group();
  if (first >= count) return;
  uint own = first + gl_LocalInvocationIndex;
  if (ON_PROCESSOR) {
    if (own < count) bin_alone(own);
    return;
  }
  find_tiles(own, own < count);
  uint pairs = tiles_before[63];
  for (uint from = 0u; from < pairs; from += 64u) bin_pairs(first, from, pairs);
}
