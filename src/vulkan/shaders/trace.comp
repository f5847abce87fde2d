// SPDX-License-Identifier: Apache-2.0
// Traces a grid of rays along a path, one ray an invocation, and finds what blocks each. Compiled in float and, with
// DOUBLE, in double.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "iris.glsl"
#include "start.glsl"

// The path's numbers are the same for all rays, so that a uniform buffer serves them best: GPUs keep it in a cache of
// its own, and lavapipe reads other buffers in a loop over the invocations.
#define PATH_NUMBERS 4096
#ifdef DOUBLE
layout(std140, set = 1, binding = 1) uniform PathReals { dvec2 path_reals_of_grid[PATH_NUMBERS]; };
real path_number(uint k) { return path_reals_of_grid[k >> 1u][k & 1u]; }
#else
layout(std140, set = 1, binding = 0) uniform PathReals { vec4 path_reals_of_grid[PATH_NUMBERS]; };
real path_number(uint k) { return path_reals_of_grid[k >> 2u][k & 3u]; }
#endif
layout(std140, set = 1, binding = 2) uniform PathIntegers { ivec4 path_integers_of_grid[PATH_NUMBERS]; };
int path_word(uint k) { return path_integers_of_grid[k >> 2u][k & 3u]; }
vec2 table_pair(int k) { return texelFetch(table_texels, k).xy; }

#define START_REALS 14u
real start_real(int k) { return path_number(uint(k)); }

#define LIKE_CPU
#include "trace.glsl"

#ifdef DIMMED
#include "coverage.glsl"
#include "stop/tables.glsl"
#include "stop/pattern.glsl"
#include "stop/occluders.glsl"
#include "stop/squares.glsl"
// Whether the iris blocks: a picture, or the circle through which grids with a stop pattern are traced.
bool is_blocked_by_iris(vec2 at) {
  return ((p.flags & FLAG_CIRCLE) != 0u ? length(at) - 1.0 : distance_from_picture(at)) > 0.0;
}
#else
bool is_blocked_by_iris(vec2 at) { return iris_distance(at) > 0.0; }
#endif

// Writes where the ray crosses the stop. Returns the bit of a crossing at which the iris blocks it.
uint keep_crossing(uint ray, uint c, vec2 at) {
  if (c >= p.crossing_count) return 0u;
  crossings[ray * MAX_CROSSINGS + c] = at;
  return is_blocked_by_iris(at) ? BLOCKED_BY_IRIS << c : 0u;
}

void main() {
  uint k = linear_invocation();
  if (k >= p.side * p.side) return;
  uint ray = p.first_ray + k;
  path_reals = START_REALS;
  path_integers = 0u;
  path_steps = p.step_count;
  vec4 arrived = trace_ray(real(k % p.side) * start_real(START_STEP_X), real(k / p.side) * start_real(START_STEP_Y));
  arrived.z *= p.triangle_weight;
  rays[ray] = arrived;
  uint blockers = arrived.w > 1.0 ? BLOCKED_BY_RIM : 0u;
  // The index of a loop would keep the points in memory.
  blockers |= keep_crossing(ray, 0u, stop_points[0]);
  blockers |= keep_crossing(ray, 1u, stop_points[1]);
  blockers |= keep_crossing(ray, 2u, stop_points[2]);
  vertices[ray].y = float(blockers);
}
