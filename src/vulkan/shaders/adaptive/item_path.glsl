// SPDX-License-Identifier: Apache-2.0
// The path of an item, for ../trace.glsl.
#include "../start.glsl"
#include "item_start.glsl"

uint path_item;

float start_real(int k) { return start_real_of(path_item, k); }
float path_number(uint k) { return floats[k]; }
int path_word(uint k) { return integers[k]; }
vec2 table_pair(int k) { return vec2(tables[k], tables[k + 1]); }

#include "../trace.glsl"

void set_path(uint item) {
  path_item = item;
  path_reals = item_word(item, 0u);
  path_integers = item_word(item, 1u);
  path_steps = item_word(item, 2u);
}
