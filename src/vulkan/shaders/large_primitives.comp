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
    uint polygon = tile_lists[k];
    if (!contains(polygon, pixel)) continue;
    uint word = RECORD_WORDS * polygon, flags = large[word + 8u];
    uvec4 corners = uvec4(large[word], large[word + 1u], large[word + 2u], large[word + 3u]);
    vec4 irradiance = vec4(word_float(word + 4u), word_float(word + 5u), word_float(word + 6u), word_float(word + 7u));
    Primitive q = Primitive(corners, irradiance, (flags & 1u) != 0u, (flags & 2u) != 0u);
    float flux = light_at(q, pixel, flags >> 2u);
    if (flux != 0.0) add_to_pixel(flux, word + 9u);
  }
  check_end(k, task.end);
  end_tile(pixel);
}
