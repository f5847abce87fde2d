// SPDX-License-Identifier: Apache-2.0
// The primitives that primitives.comp lists: those that are cut from the front, open ones from the back. A record is
// the first ray; the rays a side of the grid, the level of merging, the kind and the crossings of the stop, in one
// word; the flux; the grid, in frames with stop patterns or dirt.
layout(std430, set = 0, binding = 17) buffer Primitives { uvec4 primitives[]; };
#define LISTED_GRID_SHIFT 4u  // of a large primitive, in frames with stop patterns or dirt
#define IS_QUAD 0u
#define IS_FIRST_TRIANGLE 1u
#define IS_SECOND_TRIANGLE 2u

struct Primitive {
  uvec4 v;  // rays
  vec4 irradiance;
  bool is_triangle;
};

uvec4 record_of(uint first_ray, uint what, float flux) {
  uint grid = 0u;
#ifdef DIMMED
  grid = p.first_grid + own_grid;
#endif
  return uvec4(first_ray, p.side | p.level << 16u | what << 24u | p.crossing_count << 28u, floatBitsToUint(flux), grid);
}
uint kind_of(uvec4 record) { return record.y >> 24u & 0xfu; }
uint crossings_of(uvec4 record) { return record.y >> 28u; }
float flux_of(uvec4 record) { return uintBitsToFloat(record.z); }
uvec4 rays_of(uvec4 record) {
  uint side = record.y & 0xffffu, size = 1u << (record.y >> 16u & 0xffu);
  return record.x + size * uvec4(0u, 1u, side + 1u, side);
}
uint open_place(uint k) { return p.primitive_capacity - 1u - k; }
