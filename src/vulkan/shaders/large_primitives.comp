// SPDX-License-Identifier: Apache-2.0
// Draws the listed primitives, one tile a workgroup, one pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "iris.glsl"
#include "primitive.glsl"
#ifdef DIMMED
#include "coverage.glsl"
#include "grid_stop.glsl"
#include "primitive_stop.glsl"
#define LISTED_GRID_SHIFT 4u
#endif

void main() {
  Task task;
  if (!find_task(task)) return;
  ivec2 pixel = begin_tile(task);
  uint k = task.from;
  for (; k < task.end; ++k) {
    uint polygon = texelFetch(list_texels, int(k)).x;
    if (!contains(polygon, pixel)) continue;
    uvec4 v = large_quarter(4u * polygon), words = large_quarter(4u * polygon + 2u);
    vec4 irradiance = uintBitsToFloat(large_quarter(4u * polygon + 1u));
    vec2 corners[4];
    for (int i = 0; i < 4; ++i) corners[i] = ray_of(v[i]).xy;
    vec4 w = weights_in(corners, (words.x & 1u) != 0u, pixel);
#ifdef DIMMED
    uint crossing_count = words.x >> 2u & 3u;
    Edges edges = edges_of(v, crossing_count);
    edges.bounds = uint[MAX_CROSSINGS](words.y, words.z, words.w);
    float light = dot(w, irradiance);
    if (light == 0.0) continue;
    if ((words.x & 2u) == 0u) {
      set_grid(words.x >> LISTED_GRID_SHIFT);
      if (is_blocked_at(edges, w, crossing_count)) continue;
      light *= behind_stop(corners, v, w, crossing_count);
    }
    add_to_pixel(light);
#else
    Edges edges = edges_of(v, words.x >> 2u);
    edges.bounds = uint[MAX_CROSSINGS](words.y, words.z, words.w);
    if ((words.x & 2u) == 0u && is_blocked(edges, w)) continue;
    float flux = dot(w, irradiance);
    if (flux != 0.0) add_to_pixel(flux);
#endif
  }
  check_end(k, task.end);
  end_tile(pixel);
}
