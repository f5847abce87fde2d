// SPDX-License-Identifier: Apache-2.0
// Turns the fixed-point sums into the picture's floats, one channel of a pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"

void main() {
  uint k = linear_invocation();
  if (k >= 3u * uint(p.width) * uint(p.height)) return;
  uint low = sums[2u * k], high = sums[2u * k + 1u];
  bool negative = (high & 0x80000000u) != 0u;
  if (negative) {
    low = ~low + 1u;
    high = ~high + (low == 0u ? 1u : 0u);
  }
  float size = float(high) * 4294967296.0 + float(low);
  picture[k] = (negative ? -size : size) * p.gain[0];  // from fixed point to pixel values
}
