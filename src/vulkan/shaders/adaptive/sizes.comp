// SPDX-License-Identifier: Apache-2.0
// Sets the sizes of the dispatches that follow, from what was counted: of the cut cells (level 0), of the polygons
// (level 1), of the wide ones (level 2).
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
#include "common.glsl"

void main() {
  if (p.level == 0u)
    set_dispatch(DISPATCH_CUT, (2u * min(counters[COUNT_CUT], p.cut_capacity) + 63u) / 64u);
  else if (p.level == 1u)
    set_dispatch(DISPATCH_POLYGONS, (min(counters[COUNT_POLYGONS], p.large_capacity) + 63u) / 64u);
  else
    set_dispatch(DISPATCH_WIDE, counters[COUNT_WIDE]);
}
