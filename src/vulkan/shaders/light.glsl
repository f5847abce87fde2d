// SPDX-License-Identifier: Apache-2.0
#include "sums.glsl"

// Adds flux to a pixel of the frame, in units of the sums.
void add_light(ivec2 at, float flux) { add_fixed(2u * (uint(at.y) * uint(p.width) + uint(at.x)), to_fixed(flux)); }

// The next pixel of a box, row by row. One loop over all pixels ends earlier than two where boxes of an invocation's
// neighbours differ in shape.
void step_in(ivec4 box, inout ivec2 at) {
  bool is_last = at.x == box.z;
  at = ivec2(is_last ? box.x : at.x + 1, is_last ? at.y + 1 : at.y);
}
