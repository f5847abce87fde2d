// SPDX-License-Identifier: Apache-2.0
// Computes for each ray the irradiance of the cells around it, which share it, and whether the ray is blocked.
// CellRaster::find_irradiance() and PrimitiveBuilder::find_irradiance(), which are the same: the flux of the cells
// around a vertex over their area, hullin2011 4.1 and 4.3. Cells beyond the border count as those inside it.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "iris.glsl"
#include "quad.glsl"

#define SMOOTH_RATIO 1.5

void main() {
  uint k = linear_invocation();
  if (k >= p.side * p.side) return;
  int last = int(p.side) - 1, ix = int(k % p.side), iy = int(k / p.side);
  // The rays around; those of a cell beyond the border are those of the cell inside it.
  vec4 around[9];
  for (int j = 0; j < 9; ++j)
    around[j] = rays[ray_at(uint(clamp(ix + j % 3 - 1, 0, last)), uint(clamp(iy + j / 3 - 1, 0, last)))];
  float low = FAILED, high = -FAILED, sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    int cx = ix == 0 ? 1 : ix == last ? 0 : j % 2, cy = iy == 0 ? 1 : iy == last ? 0 : j / 2;
    int first = 3 * cy + cx;
    vec4 a = around[first], b = around[first + 1], c = around[first + 4], d = around[first + 3];
    bool fails = failed(a) || failed(b) || failed(c) || failed(d);
    float area = fails ? 0.0 : 0.5 * cross2(c.xy - a.xy, d.xy - b.xy);
    low = min(low, area);
    high = max(high, area);
    sum += area;
  }
  float smallest = min(abs(low), abs(high)), largest = max(abs(low), abs(high));
  bool is_smooth = low * high > 0.0 && largest < SMOOTH_RATIO * smallest;
  uint ray = p.first_ray + k;
  vertices[ray] = vec2(is_smooth ? 4.0 * rays[ray].z / abs(sum) : 0.0, blocked(ray));
}
