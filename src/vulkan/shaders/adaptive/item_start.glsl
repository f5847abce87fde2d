// SPDX-License-Identifier: Apache-2.0
// The numbers of an item's start. Included after ../start.glsl.
#define START_TEXELS 4u

float start_real_of(uint item, int k) {
  if (k == START_PIXEL_X || k == START_PIXEL_Y) return item_float(item, 12u + uint(k - START_PIXEL_X));
  return texelFetch(start_texels, int(START_TEXELS * item_word(item, 11u)) + (k >> 2))[k & 3];
}
