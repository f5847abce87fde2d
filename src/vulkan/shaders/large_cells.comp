// SPDX-License-Identifier: Apache-2.0
// Draws the listed polygons, one tile a workgroup, one pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "coverage.glsl"

void add_polygon(uint word, ivec2 pixel) {
  uint first = large[word + 8u], count = large[word + 9u];
  vec2 corner = vec2(pixel - ivec2(int(large[word + 10u]), int(large[word + 11u])));
  float covered = 0.0;
  vec2 before = large_corners[first + count - 1u] - corner;
  for (uint k = 0u; k < count; ++k) {
    vec2 here = large_corners[first + k] - corner;
    covered -= area_right_of(before, here);
    before = here;
  }
  if (covered <= 0.0) return;
  vec2 gradient = vec2(word_float(word + 1u), word_float(word + 2u));
  vec2 point = vec2(word_float(word + 3u), word_float(word + 4u));
  float level = word_float(word) + dot(gradient, corner + 0.5 - point);
  add_to_pixel(covered * level, word + 5u);
}

void main() {
  Task task;
  if (!find_task(task)) return;
  ivec2 pixel = begin_tile(task);
  uint k = task.from;
  for (; k < task.end; ++k) {
    uint polygon = tile_lists[k];
    if (contains(polygon, pixel)) add_polygon(RECORD_WORDS * polygon, pixel);
  }
  check_end(k, task.end);
  end_tile(pixel);
}
