// SPDX-License-Identifier: Apache-2.0
// The triangle of rays in which the pixels of a listed polygon look up what dims its light: the cell's first ray, what
// dims the cell (0: nothing, and the rest does not count), the crossings of the stop and the half of the cell, and the
// grid.
uvec3 seen_words(uint cell_ray, uint dims, uint crossing_count, bool is_second, uint grid) {
  return uvec3(cell_ray, dims | crossing_count << 8u | (is_second ? 1u : 0u) << 16u, grid);
}
uint seen_dims(uvec3 words) { return words.y & 0xffu; }
uint seen_crossing_count(uvec3 words) { return words.y >> 8u & 0xffu; }
uvec3 seen_rays(uvec3 words, uint side) {
  uvec4 v = words.x + uvec4(0u, 1u, side + 1u, side);
  return (words.y >> 16u) != 0u ? v.xzw : v.xyz;
}
