// SPDX-License-Identifier: Apache-2.0
// The task of a workgroup: a tile, and a part of the list of polygons that reach it.
struct Task {
  ivec2 tile;  // column and row
  uint from, end;  // in tile_lists
  uint split;  // from 1 on, the number of the tile among those with several parts; 0: the list has one part
  bool is_first;  // of the tile's parts
};

// False past the last task.
bool find_task(out Task task) {
  uint own = linear_group();
  if (own >= counters[COUNT_TASKS]) return false;
  uvec4 words = tile_tasks[own];
  task = Task(ivec2(words.x & 0xffffu, words.x >> 16u), words.y, words.z, words.w >> 1u, (words.w & 1u) != 0u);
  return true;
}

// After a loop over polygons: reports if it was ended early.
void check_end(uint at, uint end) {
  if (at < end) atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_TURNS);
}
