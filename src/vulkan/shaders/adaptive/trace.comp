// SPDX-License-Identifier: Apache-2.0
// Traces the grids of all items, one ray an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#include "common.glsl"
#include "grid.glsl"
#include "item_path.glsl"

vec4 box;

// The place of a ray of the grid in the window.
vec2 place_of(uint k) { return box.xy + box.zw * (vec2(k % side, k / side) / float(side - 1u)); }

void keep(uint k, vec4 ray, vec2 points[MAX_CROSSINGS]) {
  rays[first_ray + k] = ray;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c)
    if (c < crossings_of(item)) crossings[(first_ray + k) * MAX_CROSSINGS + c] = points[c];
}

void main() {
  if (!find_ray()) return;
  box = state_box(item);
  set_path(item);
  if (!ON_PROCESSOR) {
    vec2 at = place_of(own);
    vec4 ray = trace_ray(at.x, at.y);
    keep(own, ray, stop_points);
    return;
  }
  if (gl_LocalInvocationID.x >= 32u) return;  // half of the invocations trace two rays each
  TwoRays two = trace_two(place_of(own), place_of(own + 32u));
  keep(own, two.first, two.first_points);
  if (own + 32u < side * side) keep(own + 32u, two.second, two.second_points);
}
