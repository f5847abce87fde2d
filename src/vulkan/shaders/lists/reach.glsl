// SPDX-License-Identifier: Apache-2.0
// The tiles that a polygon reaches. Included after record.glsl.

// First column and row of tiles, columns, rows.
ivec4 tiles_of(uint polygon) {
  ivec4 box = box_of(polygon) / p.tile_side;
  return ivec4(box.xy, box.zw - box.xy + 1);
}
uint tile_number(ivec4 tiles, int k) {
  return uint((tiles.y + k / tiles.z) * int(p.tiles_across) + tiles.x + k % tiles.z);
}

bool are_primitives() { return (p.flags & LIST_PRIMITIVES) != 0u; }
uint corners_of(uint polygon) { return are_primitives() ? 4u : large[RECORD_WORDS * polygon + 9u] & CORNERS_MASK; }
ivec2 base_of(uint polygon) {
  uint word = RECORD_WORDS * polygon + 10u;
  return are_primitives() ? ivec2(0) : ivec2(int(large[word]), int(large[word + 1u]));
}
vec2 corner_of(uint polygon, uint k) {
  uint word = RECORD_WORDS * polygon;
  return are_primitives() ? rays[large[word + k]].xy : large_corners[large[word + 8u] + k];
}

// False where a polygon lies beside a tile, beyond one of its edges.
bool may_reach(uint polygon, ivec4 tiles, int k) {
  uint count = corners_of(polygon);
  if (count < 3u) return true;
  ivec2 tile_low = p.tile_side * (tiles.xy + ivec2(k % tiles.z, k / tiles.z));
  float half_tile = 0.5 * float(p.tile_side);
  vec2 middle = vec2(tile_low - base_of(polygon)) + half_tile;
  vec2 before = corner_of(polygon, count - 1u) - middle;
  for (uint c = 0u; c < count; ++c) {
    vec2 here = corner_of(polygon, c) - middle, along = here - before;
    float right = along.y * before.x, left = along.x * before.y;
    float rounding = 1e-6 * (abs(right) + abs(left));
    if (right - left < -half_tile * (abs(along.x) + abs(along.y)) - rounding) return false;
    before = here;
  }
  return true;
}
