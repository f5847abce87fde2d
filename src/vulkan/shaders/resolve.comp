// SPDX-License-Identifier: Apache-2.0
// Turns the fixed-point sums into the picture's floats, one channel of a pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "sums.glsl"

void main() {
  uint k = linear_invocation();
  if (k >= 3u * uint(p.width) * uint(p.height)) return;
  picture[k] = from_fixed(sums[2u * k], sums[2u * k + 1u]) * p.gain[0];  // to pixel values
}
