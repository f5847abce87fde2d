// SPDX-License-Identifier: Apache-2.0
// Traces a grid of rays along a path, one ray an invocation. Compiled in float and, with DOUBLE, in double.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "start.glsl"

#define START_REALS 14u
real start_real(int k) { return reals[p.reals_at + k]; }

#define LIKE_CPU
#include "trace.glsl"

void main() {
  uint k = linear_invocation();
  if (k >= p.side * p.side) return;
  uint ray = p.first_ray + k;
  path_reals = p.reals_at + START_REALS;
  path_integers = p.integers_at;
  path_steps = p.step_count;
  rays[ray] = trace_ray(real(k % p.side) * start_real(START_STEP_X), real(k / p.side) * start_real(START_STEP_Y));
  for (uint c = 0u; c < p.crossing_count; ++c) crossings[ray * MAX_CROSSINGS + c] = stop_points[c];
}
