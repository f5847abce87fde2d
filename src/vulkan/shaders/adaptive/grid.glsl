// SPDX-License-Identifier: Apache-2.0
// The grid of an item's rays, as an invocation finds it from its number.
uint item, side, first_ray;  // rays a side
uint own;                    // the invocation's ray in the grid

// False where no ray has the invocation's number.
bool find_ray() {
  uint block = linear_group();
  if (block >= counters[COUNT_BLOCKS]) return false;
  item = item_of_block(block);
  side = cells_of(item) + 1u;
  first_ray = 64u * offset_of(item);
  own = 64u * (block - offset_of(item)) + gl_LocalInvocationID.x;
  return own < side * side;
}
uint ray_at(uint ix, uint iy) { return first_ray + iy * side + ix; }
