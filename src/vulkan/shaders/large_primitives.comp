// SPDX-License-Identifier: Apache-2.0
// Draws the listed primitives, one tile a workgroup, one pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "iris.glsl"
#include "primitive.glsl"

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
    Edges edges = edges_of(v, words.x >> 2u);
    edges.bounds = uint[MAX_CROSSINGS](words.y, words.z, words.w);
    if ((words.x & 2u) == 0u && is_blocked(edges, w)) continue;
    float flux = dot(w, irradiance);
    if (flux != 0.0) add_to_pixel(flux);
  }
  check_end(k, task.end);
  end_tile(pixel);
}
