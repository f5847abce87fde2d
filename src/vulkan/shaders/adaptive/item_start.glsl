// SPDX-License-Identifier: Apache-2.0
// The numbers of an item's start. Included after ../start.glsl.
#define START_NUMBERS 14u

float start_real_of(uint item, int k) {
  if (k == START_PIXEL_X || k == START_PIXEL_Y) return item_float(item, 12u + uint(k - START_PIXEL_X));
  return starts[START_NUMBERS * item_word(item, 11u) + uint(k)];
}
