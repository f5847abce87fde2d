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
// The numbers of what describes the corners: four rays, or those in words 8 to 11 of the record.
uvec4 corner_words_of(uint polygon) { return large_quarter(4u * polygon + (are_primitives() ? 0u : 2u)); }
uint corners_of(uvec4 words) { return are_primitives() ? 4u : words.y & CORNERS_MASK; }
bool is_concave(uvec4 words) { return !are_primitives() && (words.y & CONCAVE) != 0u; }
ivec2 base_of(uvec4 words) { return are_primitives() ? ivec2(0) : ivec2(words.zw); }
vec2 corner_of(uvec4 words, uint k) { return are_primitives() ? ray_of(words[k]).xy : large_corner(words.x + k); }

// False where a convex polygon lies beside a tile, beyond one of its edges.
bool may_reach(uint polygon, ivec4 tiles, int k) {
  uvec4 words = corner_words_of(polygon);
  uint count = corners_of(words);
  if (count < 3u || is_concave(words)) return true;
  ivec2 tile_low = p.tile_side * (tiles.xy + ivec2(k % tiles.z, k / tiles.z));
  float half_tile = 0.5 * float(p.tile_side);
  vec2 middle = vec2(tile_low - base_of(words)) + half_tile;
  vec2 before = corner_of(words, count - 1u) - middle;
  for (uint c = 0u; c < count; ++c) {
    vec2 here = corner_of(words, c) - middle, along = here - before;
    float right = along.y * before.x, left = along.x * before.y;
    float rounding = 1e-6 * (abs(right) + abs(left));
    if (right - left < -half_tile * (abs(along.x) + abs(along.y)) - rounding) return false;
    before = here;
  }
  return true;
}
