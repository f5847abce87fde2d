// SPDX-License-Identifier: Apache-2.0
// The irradiance at each ray, as ../vertices.comp, for the grids of all items.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#define SMOOTH_RATIO 2.5  // cells are larger than those of `bundle`, and their planes serve this far
#include "../vertex.glsl"
#include "../stop/pattern_record.glsl"

void main() {
  if (!find_ray()) return;
  uint pattern = pattern_of(item), ray = first_ray + own, count = crossings_of(item);
  uint sharp = HAS_PICTURE ? 0u : pattern == 0u ? count : count - 1u;  // crossings
  vec2 vertex = vec2(shared_irradiance(own % side, own / side, side), blocked(ray, sharp));
  for (uint c = sharp; c < count; ++c)
    vertex.y = max(vertex.y, length(crossing(ray, c)) - stop_radius(pattern, c, count));
  vertices[ray] = vertex;
}
