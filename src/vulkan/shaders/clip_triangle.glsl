// SPDX-License-Identifier: Apache-2.0
// Clips triangles of rays by rims and the iris: render/bundle/cell_clip.cpp under the same names. Functions are linear
// in a triangle, and described by its first, second and third corner.
#include "polygon.glsl"
float values_of_bound[3];  // at the triangle's corners

float bound_at(vec2 at) {
  return values_of_bound[0] + at.x * (values_of_bound[1] - values_of_bound[0]) +
         at.y * (values_of_bound[2] - values_of_bound[0]);
}
#include "cut_polygon.glsl"

// The triangle that is clipped: relative heights, and where the rays cross the stop.
float heights_of_triangle[3];
vec2 stops_of_triangle[MAX_CROSSINGS][3];

// Keeps the part where a linear function is <= 0.
void cut(float at_0, float at_1, float at_2) {
  if (at_0 <= 0.0 && at_1 <= 0.0 && at_2 <= 0.0) return;
  values_of_bound = float[3](at_0, at_1, at_2);
  cut_by_bound();
}

void clip_by_edge(vec2 stop[3], vec2 normal, float half_extent) {
  cut(dot(normal, stop[0]) - half_extent, dot(normal, stop[1]) - half_extent, dot(normal, stop[2]) - half_extent);
}

// Clips by a straight bound of a normal and an extent, or by tangents of a circle of a centre and a radius.
void clip_by_bound(vec2 stop[3], bool straight, vec2 place, float extent) {
  vec2 middle = (stop[0] + stop[1] + stop[2]) * (1.0 / 3.0) - place;
  float half_extent = 0.0;
  for (int k = 0; k < 3; ++k) half_extent = max(half_extent, length(stop[k] - place - middle));
  Arc arc = arc_within(middle, half_extent, extent);
  int tangents = straight ? 1 : arc.tangents;
  for (int k = 0; k < tangents; ++k) {
    vec2 normal = straight ? place : tangent_normal(arc, k);
    clip_by_edge(stop, normal, straight ? extent : extent + dot(normal, place));
  }
}

#ifdef DIMMED
// Whether the present grid's rays are traced through a circle in place of the iris, since the iris has a stop pattern.
bool clips_by_circle = false;
bool is_circle() { return clips_by_circle || (p.flags & FLAG_CIRCLE) != 0u; }
#else
bool is_circle() { return (p.flags & FLAG_CIRCLE) != 0u; }
#endif
bool is_beyond(uint b, vec2 q) { return (is_circle() ? length(q) - 1.0 : bound_distance(b, q)) > 0.0; }

// Bounds are found before they clip, 32 at a time, and all clip at one place: lavapipe clips in each turn of a loop in
// which one invocation does, and on both sides of branches.
void clip_by_iris(uint c) {
  vec2 stop[3] = stops_of_triangle[c];
  uint bounds_of_iris = is_circle() ? 1u : p.bound_count;
  for (uint from = 0u; from < bounds_of_iris; from += 32u) {
    uint left = 0u, count = min(bounds_of_iris - from, 32u);
    for (uint k = 0u; k < count; ++k) {
      uint b = from + k;
      left |= is_beyond(b, stop[0]) || is_beyond(b, stop[1]) || is_beyond(b, stop[2]) ? 1u << k : 0u;
    }
    for (; left != 0u; left &= left - 1u) {
      uint b = from + uint(findLSB(left));
      vec4 line = bound_half(2u * b), circle = bound_half(2u * b + 1u);
      bool straight = !is_circle() && line.w != 0.0;
      vec2 place = is_circle() ? vec2(0.0) : straight ? line.xy : circle.xy;
      clip_by_bound(stop, straight, place, is_circle() ? 1.0 : straight ? line.z : circle.z);
    }
  }
}

void set_triangle(uvec3 t, uint crossing_count) {
  for (int k = 0; k < 3; ++k) {
    heights_of_triangle[k] = ray_of(t[k]).w;
    for (uint c = 0u; c < MAX_CROSSINGS; ++c)
      if (c < crossing_count) stops_of_triangle[c][k] = crossing(t[k], c);
  }
}

// The whole triangle, in (u, v).
void begin_triangle() {
  for (int k = 0; k < FEW_CORNERS; ++k) few[k] = vec2(float(k == 1), float(k == 2));
  has_few = true;
  corner_count = 3;
}

void clip_by_rims() { cut(heights_of_triangle[0] - 1.0, heights_of_triangle[1] - 1.0, heights_of_triangle[2] - 1.0); }

// Leaves the open part of the triangle of rays.
void clip_triangle(uint crossing_count) {
  clip_by_rims();
  for (uint c = 0u; c < crossing_count && corner_count >= 3; ++c) clip_by_iris(c);
  end_cuts();
}
