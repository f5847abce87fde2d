// SPDX-License-Identifier: Apache-2.0
// Traces the grids of all items, one ray an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#include "common.glsl"
#include "grid.glsl"
#include "item_path.glsl"

void main() {
  if (!find_ray()) return;
  vec4 box = state_box(item);
  set_path(item);
  vec2 at = box.xy + box.zw * (vec2(own % side, own / side) / float(side - 1u));
  uint ray = first_ray + own;
  rays[ray] = trace_ray(at.x, at.y);
  for (uint c = 0u; c < crossings_of(item); ++c) crossings[ray * MAX_CROSSINGS + c] = stop_points[c];
}
