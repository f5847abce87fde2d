// SPDX-License-Identifier: Apache-2.0
// The path of an item, for ../trace.glsl.
#include "../start.glsl"
#include "item_start.glsl"

uint path_item;

float start_real(int k) { return start_real_of(path_item, k); }

#include "../trace.glsl"

void set_path(uint item) {
  path_item = item;
  path_reals = item_word(item, 0u);
  path_integers = item_word(item, 1u);
  path_steps = item_word(item, 2u);
}
