// SPDX-License-Identifier: Apache-2.0
// Computes for each ray of a grid the irradiance there.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "quad.glsl"
#include "vertex.glsl"

void main() {
  uint k = linear_invocation(), count = p.side * p.side;
  if (k >= p.grid_count * count) return;
  uint ray = p.first_ray + k, own = k % count;
  first_ray = ray - own;
  vertices[ray].x = shared_irradiance(own % p.side, own / p.side, p.side);
}
