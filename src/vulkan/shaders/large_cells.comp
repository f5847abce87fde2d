// SPDX-License-Identifier: Apache-2.0
// Draws the listed polygons, one tile a workgroup, one pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "bindings.glsl"
#include "tile.glsl"
#include "coverage.glsl"
#ifdef DIMMED
#include "iris.glsl"
#include "grid_stop.glsl"
#include "seen_triangle.glsl"
#define NEGLIGIBLE_COVERAGE 1e-6

// The transmittance in a pixel of a listed polygon. words: those of seen_triangle.glsl.
float transmitted_in(uvec3 words, ivec2 pixel) {
  if (seen_dims(words) == 0u) return 1.0;
  set_grid(words.z);
  see_triangle(seen_rays(words, grid_side), seen_crossing_count(words), vec2(pixel));
  return transmitted_at(seen_dims(words), vec2(0.5));
}
#endif

void add_polygon(uint polygon, ivec2 pixel) {
  uvec4 words = large_quarter(4u * polygon + 2u);
  uint first = words.x, count = words.y;
  vec2 corner = vec2(pixel - ivec2(words.zw));
  float covered = 0.0;
  vec2 before = large_corner(first + count - 1u) - corner;
  for (uint k = 0u; k < count; ++k) {
    vec2 here = large_corner(first + k) - corner;
    covered -= area_right_of(before, here);
    before = here;
  }
#ifdef DIMMED
  if (covered <= NEGLIGIBLE_COVERAGE) return;
  covered *= transmitted_in(large_quarter(4u * polygon + 1u).yzw, pixel);
#else
  if (covered <= 0.0) return;
#endif
  vec4 density = uintBitsToFloat(large_quarter(4u * polygon));
  vec2 point = vec2(density.w, uintBitsToFloat(large_quarter(4u * polygon + 1u).x));
  add_to_pixel(covered * (density.x + dot(density.yz, corner + 0.5 - point)));
}

void main() {
  Task task;
  if (!find_task(task)) return;
  ivec2 pixel = begin_tile(task);
  uint k = task.from;
  for (; k < task.end; ++k) {
    uint polygon = texelFetch(list_texels, int(k)).x;
    if (contains(polygon, pixel)) add_polygon(polygon, pixel);
  }
  check_end(k, task.end);
  end_tile(pixel);
}
