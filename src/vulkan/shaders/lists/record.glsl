// SPDX-License-Identifier: Apache-2.0
// Reads what adaptive/list.glsl, cells.comp and primitives.comp have listed, whose bounds lie at the same place.
#include "record_words.glsl"

float record_float(uint polygon, uint k) { return uintBitsToFloat(large[RECORD_WORDS * polygon + k]); }
ivec4 box_of(uint polygon) {
  return ivec4(large_quarter(4u * polygon + 3u));
}
