// SPDX-License-Identifier: Apache-2.0
// The path of an item, for ../trace.glsl.
#include "../start.glsl"

#define START_NUMBERS 14u
uint path_item;

float start_real(int k) {
  if (k == START_PIXEL_X || k == START_PIXEL_Y) return item_float(path_item, 12u + uint(k - START_PIXEL_X));
  return starts[START_NUMBERS * item_word(path_item, 11u) + uint(k)];
}

#include "../trace.glsl"

void set_path(uint item) {
  path_item = item;
  path_reals = item_word(item, 0u);
  path_integers = item_word(item, 1u);
  path_steps = item_word(item, 2u);
}
