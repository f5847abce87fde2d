// SPDX-License-Identifier: Apache-2.0
// The irradiance at each ray, as ../vertices.comp, for the grids of all items.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "../vertex.glsl"

void main() {
  if (find_ray()) vertices[first_ray + own] = vertex_at(own % side, own / side, side, crossings_of(item));
}
