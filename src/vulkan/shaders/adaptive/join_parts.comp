// SPDX-License-Identifier: Apache-2.0
// Turns the sums of the tiles that were drawn in parts into pixels: a task a workgroup, of which the first of a tile works.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
#include "common.glsl"
#include "../lists/task.glsl"
#include "../sums.glsl"
#include "parts.glsl"

void main() {
  Task task;
  if (!find_task(task) || task.split == 0u || !task.is_first) return;
  ivec2 pixel = TILE_SIDE * task.tile + ivec2(gl_LocalInvocationID.xy);
  if (pixel.x >= p.width || pixel.y >= p.height) return;
  uint from = SPLIT_SUMS + TILE_WORDS * (task.split - 1u) + 6u * gl_LocalInvocationIndex;
  uint at = 3u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  float units = units_of(frame_peak());
  for (uint c = 0u; c < 3u; ++c) picture[at + c] = from_fixed(sums[from + 2u * c], sums[from + 2u * c + 1u]) / units;
}
