// SPDX-License-Identifier: Apache-2.0
// Sets the size of the dispatch of parts of cut cells, from what was counted.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
#include "common.glsl"

void main() { set_dispatch(DISPATCH_CUT, (min(counters[COUNT_CUT], p.cut_capacity) + 63u) / 64u); }
