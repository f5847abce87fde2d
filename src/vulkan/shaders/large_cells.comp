// SPDX-License-Identifier: Apache-2.0
// Draws the listed polygons, one tile a workgroup, one pixel an invocation. The invocations of a tile sort out
// together which polygons reach it.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "coverage.glsl"

void add_polygon(uint word, ivec2 pixel) {
  uint first = large[word + 8u], count = large[word + 9u];
  vec2 corner = vec2(pixel - ivec2(int(large[word + 10u]), int(large[word + 11u])));
  float covered = 0.0, twice = 0.0;
  vec2 origin = large_corners[first], before = large_corners[first + count - 1u];
  for (uint k = 0u; k < count; ++k) {
    vec2 here = large_corners[first + k];
    covered += area_right_of(before - corner, here - corner);
    twice += (before.x - origin.x) * (here.y - origin.y) - (before.y - origin.y) * (here.x - origin.x);
    before = here;
  }
  covered *= twice < 0.0 ? 1.0 : -1.0;
  if (covered <= 0.0) return;
  vec2 gradient = vec2(word_float(word + 1u), word_float(word + 2u));
  vec2 point = vec2(word_float(word + 3u), word_float(word + 4u));
  float level = word_float(word) + dot(gradient, corner + 0.5 - point);
  add_to_pixel(covered * level, word + 5u);
}

void main() {
  ivec2 pixel = begin_tile();
  uint count = min(counters[COUNT_LARGE], p.large_capacity);
  for (uint from = 0u; from < count; from += TILE_PIXELS) {
    uint reaching = find_reaching(from, count);
    for (uint k = 0u; k < reaching; ++k) {
      uint word = 16u * reaching_polygons[k];
      if (contains(word, pixel)) add_polygon(word, pixel);
    }
    barrier();
  }
  end_tile(pixel);
}
