// SPDX-License-Identifier: Apache-2.0
// Reads the PatternRecord (stop_layout.h) of a stop pattern by its number from 1 on; 0 is the sharp iris.
#define PATTERN_WORDS 9u

uint pattern_word(uint pattern, uint k) { return patterns[PATTERN_WORDS * (pattern - 1u) + k]; }
uint pattern_table(uint pattern) { return pattern_word(pattern, 0u); }
uint pattern_side(uint pattern) { return pattern_word(pattern, 1u); }  // 0: fringes of edges
uint pattern_levels(uint pattern) { return pattern_word(pattern, 2u); }
float pattern_outer_radius(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 3u)); }
float pattern_scale(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 4u)); }
float pattern_level_from(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 5u)); }
float pattern_roughness(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 6u)); }
float pattern_difference(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 7u)); }
float pattern_uniform_from(uint pattern) { return uintBitsToFloat(pattern_word(pattern, 8u)); }

#define PICTURE_RADIUS 1.05  // pixels that cross the rim have their middle beyond it (kSharpOuterRadius)

// The radius within which light crosses the stop.
float stop_radius(uint pattern, uint c, uint crossing_count) {
  float sharp = HAS_PICTURE ? PICTURE_RADIUS : 1.0;
  return pattern != 0u && c + 1u == crossing_count ? max(pattern_outer_radius(pattern), sharp) : sharp;
}
