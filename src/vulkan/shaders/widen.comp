// SPDX-License-Identifier: Apache-2.0
// Widens a ghost that is too narrow for sampling at pixels' middles, as PrimitiveBuilder::widen(): one workgroup a
// grid, whose sums are in a fixed order.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"

#define NARROW_PX 0.25
#define WIDENED_PX 3.0
#define MAX_WIDENING 1.0e6

shared double part[64][3];

// The sums of three numbers over the workgroup.
dvec3 sum_over_group(dvec3 mine) {
  uint me = gl_LocalInvocationIndex;
  barrier();
  for (int k = 0; k < 3; ++k) part[me][k] = mine[k];
  barrier();
  for (uint half_size = 32u; half_size > 0u; half_size /= 2u) {
    if (me < half_size)
      for (int k = 0; k < 3; ++k) part[me][k] += part[me + half_size][k];
    barrier();
  }
  return dvec3(part[0][0], part[0][1], part[0][2]);
}

// The variance of a uniform distribution is a twelfth of its width squared.
float widening(double squares, double count) {
  float width_px = sqrt(float(12.0 * max(squares, 0.0) / count));
  return width_px < NARROW_PX ? min(WIDENED_PX / max(width_px, 1e-12), MAX_WIDENING) : 1.0;
}

void main() {
  uint rays_of_grid = p.side * p.side, first_ray = p.first_ray + linear_group() * rays_of_grid;
  if (linear_group() >= p.grid_count) return;
  dvec3 sums = dvec3(0.0);
  for (uint k = gl_LocalInvocationIndex; k < rays_of_grid; k += 64u) {
    uint ray = first_ray + k;
    if (passes(ray)) sums += dvec3(1.0, rays[ray].xy);
  }
  dvec3 moments = sum_over_group(sums);
  double count = moments.x;
  if (count < 3.0) return;
  dvec2 mean = moments.yz / count;
  sums = dvec3(0.0);
  for (uint k = gl_LocalInvocationIndex; k < rays_of_grid; k += 64u) {
    uint ray = first_ray + k;
    dvec2 from = dvec2(rays[ray].xy) - mean;
    if (passes(ray)) sums += dvec3(from.x * from.x, from.x * from.y, from.y * from.y);
  }
  dvec3 squares = sum_over_group(sums);
  float axis_angle = 0.5 * atan(float(2.0 * squares.y), float(squares.x - squares.z));
  vec2 along = vec2(cos(axis_angle), sin(axis_angle));
  double middle = 0.5 * (squares.x + squares.z), difference = 0.5 * (squares.x - squares.z);
  double half_difference = sqrt(difference * difference + squares.y * squares.y);
  float by_along = widening(middle + half_difference, count), by_across = widening(middle - half_difference, count);
  if (by_along == 1.0 && by_across == 1.0) return;
  for (uint k = gl_LocalInvocationIndex; k < rays_of_grid; k += 64u) {
    uint ray = first_ray + k;
    vec2 from = vec2(dvec2(rays[ray].xy) - mean);
    float a = by_along * dot(from, along), b = by_across * (along.x * from.y - along.y * from.x);
    rays[ray].xy = vec2(mean) + vec2(a * along.x - b * along.y, a * along.y + b * along.x);
  }
}
