// SPDX-License-Identifier: Apache-2.0
// Reads what adaptive/list.glsl, cells.comp and primitives.comp have listed, whose bounds lie at the same place.
#define RECORD_WORDS 16u
#define PATTERN_SHIFT 8u
#define CORNERS_MASK 0x7fu
#define CONCAVE 0x80u  // a flag beside the number of corners

float record_float(uint polygon, uint k) { return uintBitsToFloat(large[RECORD_WORDS * polygon + k]); }
ivec4 box_of(uint polygon) {
  return ivec4(large_quarter(4u * polygon + 3u));
}
