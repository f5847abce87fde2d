// SPDX-License-Identifier: Apache-2.0
// Reads what list.glsl has listed.
#define RECORD_WORDS 16u
#define PATTERN_SHIFT 8u
#define CORNERS_MASK 0xffu

float record_float(uint polygon, uint k) { return uintBitsToFloat(large[RECORD_WORDS * polygon + k]); }
ivec4 box_of(uint polygon) {
  uint word = RECORD_WORDS * polygon + 12u;
  return ivec4(int(large[word]), int(large[word + 1u]), int(large[word + 2u]), int(large[word + 3u]));
}

// First column and row of tiles, columns, rows.
ivec4 tiles_of(uint polygon) {
  ivec4 box = box_of(polygon) / TILE_SIDE;
  return ivec4(box.xy, box.zw - box.xy + 1);
}
uint tile_number(ivec4 tiles, int k) {
  return uint((tiles.y + k / tiles.z) * int(p.tiles_across) + tiles.x + k % tiles.z);
}

// False where a polygon lies beside a tile, beyond one of its edges.
bool may_reach(uint polygon, ivec4 tiles, int k) {
  uint word = RECORD_WORDS * polygon, first = large[word + 8u], count = large[word + 9u] & CORNERS_MASK;
  if (count < 3u) return true;
  ivec2 tile_low = TILE_SIDE * (tiles.xy + ivec2(k % tiles.z, k / tiles.z));
  const float half_tile = 0.5 * float(TILE_SIDE);
  vec2 middle = vec2(tile_low - ivec2(int(large[word + 10u]), int(large[word + 11u]))) + half_tile;
  vec2 before = large_corners[first + count - 1u] - middle;
  for (uint c = 0u; c < count; ++c) {
    vec2 here = large_corners[first + c] - middle, along = here - before;
    if (along.y * before.x - along.x * before.y < -half_tile * (abs(along.x) + abs(along.y))) return false;
    before = here;
  }
  return true;
}
