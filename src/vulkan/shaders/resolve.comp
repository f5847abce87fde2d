// SPDX-License-Identifier: Apache-2.0
// Adds the sums of grids of the same gains to the picture, one pixel an invocation, and makes them 0 for the next.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "sums.glsl"

void main() {
  uint k = linear_invocation();
  if (k >= uint(p.width) * uint(p.height)) return;
  bool is_first = (p.flags & FLAG_FIRST) != 0u;
  uvec2 sum = uvec2(sums[2u * k], sums[2u * k + 1u]);
  if (sum == uvec2(0u) && !is_first) return;
  float light = from_fixed(sum.x, sum.y);
  for (uint c = 0u; c < 3u; ++c) {
    float before = is_first ? 0.0 : picture[3u * k + c];
    picture[3u * k + c] = before + light * p.gain[c];
  }
  sums[2u * k] = 0u;
  sums[2u * k + 1u] = 0u;
}
