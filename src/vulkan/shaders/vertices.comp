// SPDX-License-Identifier: Apache-2.0
// Computes for each ray of a grid the irradiance there, and whether the ray is blocked.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "iris.glsl"
#include "quad.glsl"
#include "vertex.glsl"

void main() {
  uint k = linear_invocation();
  if (k < p.side * p.side) vertices[p.first_ray + k] = vertex_at(k % p.side, k / p.side, p.side, p.crossing_count);
}
