// SPDX-License-Identifier: Apache-2.0
// The words of a listed polygon's record that lists/ and adaptive/ share. Word 9 has the number of corners, a flag, and
// the number of a stop pattern or a mask.
#define RECORD_WORDS 16u
#define CORNERS_MASK 0x7fu
#define CONCAVE 0x80u  // the flag: the polygon may not be convex
#define PATTERN_SHIFT 8u
