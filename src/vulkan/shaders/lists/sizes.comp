// SPDX-License-Identifier: Apache-2.0
// Sets the sizes of the dispatches that follow, from what was counted: of all polygons (level 0), of the wide ones
// (level 1), of the tasks (level 2), or of what is drawn before them (level 3): open and cut primitives, or the two
// triangles of cut cells.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
#include "parameters.glsl"

void main() {
  if (p.level == 0u) {
    set_dispatch(DISPATCH_POLYGONS, (min(counters[COUNT_POLYGONS], p.large_capacity) + 63u) / 64u);
  } else if (p.level == 1u) {
    set_dispatch(DISPATCH_WIDE, counters[COUNT_WIDE]);
  } else if (p.level == 2u) {  // if a buffer did not suffice, the host draws again
    set_dispatch(DISPATCH_TILES, counters[COUNT_OVERFLOWS] == 0u ? counters[COUNT_TASKS] : 0u);
  } else {
    uint halves = (p.flags & LIST_PRIMITIVES) != 0u ? 1u : 2u;
    set_dispatch(DISPATCH_OPEN, (counters[COUNT_OPEN] + 63u) / 64u);
    set_dispatch(DISPATCH_CUT, (halves * counters[COUNT_CUT] + 63u) / 64u);
  }
}
