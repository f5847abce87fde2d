// SPDX-License-Identifier: Apache-2.0
// The polygon of an invocation, and what clips it: render/bundle/cell_clip.cpp under the same names.
#define MAX_CORNERS 40
#define MAX_TANGENTS 12

// In (u, v) of a triangle, then in pixels relative to a base. Between cuts it lies in either half.
vec2 polygon[2 * MAX_CORNERS];
int corner_count, first_corner = 0;

// The triangle of rays that is clipped: relative heights, and where the rays cross the stop.
float heights_of_triangle[3];
vec2 stops_of_triangle[MAX_CROSSINGS][3];

// Keeps the part where a function that is linear over the triangle is <= 0 (Sutherland-Hodgman).
void cut(float at_0, float at_1, float at_2) {
  if (at_0 <= 0.0 && at_1 <= 0.0 && at_2 <= 0.0) return;
  int count = 0, to = first_corner == 0 ? MAX_CORNERS : 0;
  vec2 a = polygon[first_corner];
  float fa = at_0 + a.x * (at_1 - at_0) + a.y * (at_2 - at_0);
  for (int k = 0; k < corner_count; ++k) {
    vec2 b = polygon[first_corner + (k + 1 == corner_count ? 0 : k + 1)];
    float fb = at_0 + b.x * (at_1 - at_0) + b.y * (at_2 - at_0);
    if (fa <= 0.0 && count < MAX_CORNERS) polygon[to + count++] = a;
    if ((fa <= 0.0) != (fb <= 0.0) && count < MAX_CORNERS) polygon[to + count++] = a + (b - a) * (fa / (fa - fb));
    a = b;
    fa = fb;
  }
  first_corner = to;
  corner_count = count;
}

void end_cuts() {
  if (first_corner != 0)
    for (int k = 0; k < corner_count; ++k) polygon[k] = polygon[first_corner + k];
  first_corner = 0;
}

void clip_by_edge(vec2 stop[3], vec2 normal, float half_extent) {
  cut(dot(normal, stop[0]) - half_extent, dot(normal, stop[1]) - half_extent, dot(normal, stop[2]) - half_extent);
}

// Tangents of a circle of radius r >= 1 deviate from its arc by less than 3e-4 if their spacing is 0.05 over sqrt(r).
void clip_by_circle(vec2 stop[3], vec2 centre, float radius) {
  vec2 middle = (stop[0] + stop[1] + stop[2]) * (1.0 / 3.0) - centre;
  float half_extent = 0.0;
  for (int k = 0; k < 3; ++k) half_extent = max(half_extent, length(stop[k] - centre - middle));
  float distance = length(middle);
  float half_angle = distance > 1.5 * half_extent ? asin(half_extent / distance) : 3.14159265;
  float step_rad = 0.05 / sqrt(max(radius, 1.0));
  int tangents = min(1 + int(ceil(2.0 * half_angle / step_rad)), MAX_TANGENTS);
  float middle_angle = atan(middle.y, middle.x);
  for (int k = 0; k < tangents; ++k) {
    float angle = middle_angle + half_angle * (float(2 * k + 1) / float(tangents) - 1.0);
    vec2 normal = vec2(cos(angle), sin(angle));
    clip_by_edge(stop, normal, radius + dot(normal, centre));
  }
}

bool is_beyond(uint b, vec2 stop[3]) {
  return bound_distance(b, stop[0]) > 0.0 || bound_distance(b, stop[1]) > 0.0 || bound_distance(b, stop[2]) > 0.0;
}

void clip_by_bound(vec2 stop[3], uint b) {
  if (is_straight(b))
    clip_by_edge(stop, bound_normal(b), bound_apothem(b));
  else
    clip_by_circle(stop, bound_centre(b), bound_radius(b));
}

// Bounds are found before they clip, 32 at a time: lavapipe clips in all turns of a loop in which one invocation does.
void clip_by_bounds(vec2 stop[3]) {
  for (uint from = 0u; from < p.bound_count; from += 32u) {
    uint left = 0u, count = min(p.bound_count - from, 32u);
    for (uint k = 0u; k < count; ++k) left |= is_beyond(from + k, stop) ? 1u << k : 0u;
    for (; left != 0u; left &= left - 1u) clip_by_bound(stop, from + uint(findLSB(left)));
  }
}

void clip_by_iris(uint c) {
  vec2 stop[3] = stops_of_triangle[c];
  if (iris_distance(stop[0]) <= 0.0 && iris_distance(stop[1]) <= 0.0 && iris_distance(stop[2]) <= 0.0) return;
  if ((p.flags & FLAG_CIRCLE) != 0u) {
    clip_by_circle(stop, vec2(0.0), 1.0);
  } else {
    clip_by_bounds(stop);
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
  polygon[0] = vec2(0.0);
  polygon[1] = vec2(1.0, 0.0);
  polygon[2] = vec2(0.0, 1.0);
  corner_count = 3;
}

// Leaves the open part of the triangle of rays.
void clip_triangle(uint crossing_count) {
  cut(heights_of_triangle[0] - 1.0, heights_of_triangle[1] - 1.0, heights_of_triangle[2] - 1.0);
  for (uint c = 0u; c < crossing_count && corner_count >= 3; ++c) clip_by_iris(c);
  end_cuts();
}

float twice_polygon_area() {
  float twice = 0.0;
  vec2 origin = polygon[0], a = polygon[1] - origin;
  for (int k = 2; k < corner_count; ++k) {
    vec2 b = polygon[k] - origin;
    twice += a.x * b.y - a.y * b.x;
    a = b;
  }
  return twice;
}
