// SPDX-License-Identifier: Apache-2.0
// The polygon of an invocation, and what clips it: render/bundle/cell_clip.cpp under the same names.
#define MAX_CORNERS 40
#define MAX_TANGENTS 12

// In (u, v) of what is clipped, then in pixels relative to a base. Between cuts it may lie in the upper half.
vec2 polygon[2 * MAX_CORNERS];
int corner_count, first_corner = 0;
// A polygon of few corners is here while it is clipped, without indices that vary, which would keep it in memory: on
// lavapipe each such number is written in a branch of its own.
#define FEW_CORNERS 8
vec2 few[FEW_CORNERS];
bool has_few;

// The triangle of rays that is clipped: relative heights, and where the rays cross the stop. A quadrilateral is described by
// its first, second and last corner, and by how far the third one is from making it a parallelogram; functions are
// bilinear in it.
float heights_of_triangle[3];
vec2 stops_of_triangle[MAX_CROSSINGS][3];
#ifdef QUADRILATERALS
bool is_quad = false;
float height_twist = 0.0;
vec2 stop_twists[MAX_CROSSINGS];
vec2 twist_of(uint c) { return is_quad ? stop_twists[c] : vec2(0.0); }
#else
const bool is_quad = false;
const float height_twist = 0.0;
vec2 twist_of(uint c) { return vec2(0.0); }
#endif

void append_few(inout vec2 next[FEW_CORNERS], inout int count, int most, bool appends, vec2 corner) {
  for (int j = 0; j < FEW_CORNERS; ++j)
    if (j <= most) next[j] = appends && count == j ? corner : next[j];
  count += appends ? 1 : 0;
}

// A function at a place in (u, v), from its values at the corners.
float value_between(vec2 at, float at_0, float at_1, float at_2, float twist) {
  float value = at_0 + at.x * (at_1 - at_0) + at.y * (at_2 - at_0);
  return is_quad ? value + at.x * at.y * twist : value;
}

void cut_few(float at_0, float at_1, float at_2, float twist) {
  vec2 next[FEW_CORNERS] = few;
  int count = 0;
  vec2 a = few[0];
  float fa = value_between(a, at_0, at_1, at_2, twist);
  for (int k = 0; k < FEW_CORNERS - 1; ++k) {  // one corner more leaves the cut
    bool exists = k < corner_count;
    vec2 b = k + 1 >= corner_count ? few[0] : few[k + 1];
    float fb = value_between(b, at_0, at_1, at_2, twist);
    append_few(next, count, k + 1, exists && fa <= 0.0, a);
    append_few(next, count, k + 1, exists && (fa <= 0.0) != (fb <= 0.0), a + (b - a) * (fa / (fa - fb)));
    a = b;
    fa = fb;
  }
  few = next;
  corner_count = count;
}

// Copies few[] to polygon[].
void keep_few() {
  if (!has_few) return;
  for (int k = 0; k < FEW_CORNERS; ++k) polygon[k] = few[k];
  has_few = false;
}

void end_cuts() {
  keep_few();
  if (first_corner != 0)
    for (int k = 0; k < corner_count; ++k) polygon[k] = polygon[first_corner + k];
  first_corner = 0;
}

// Each turn of the loop writes a corner, or the point at which the edge from it crosses, so that one place writes:
// lavapipe executes this for polygons of few corners, too.
void cut_many(float at_0, float at_1, float at_2, float twist) {
  int count = 0, to = first_corner == 0 ? MAX_CORNERS : 0;
  vec2 a = polygon[first_corner];
  float fa = value_between(a, at_0, at_1, at_2, twist);
  for (int k = 0; k < 2 * corner_count; ++k) {
    bool is_crossing = (k & 1) != 0;
    vec2 b = polygon[first_corner + (k / 2 + 1 == corner_count ? 0 : k / 2 + 1)];
    float fb = value_between(b, at_0, at_1, at_2, twist);
    bool appends = is_crossing ? (fa <= 0.0) != (fb <= 0.0) : fa <= 0.0;
    if (appends && count < MAX_CORNERS) polygon[to + count++] = is_crossing ? a + (b - a) * (fa / (fa - fb)) : a;
    a = is_crossing ? b : a;
    fa = is_crossing ? fb : fa;
  }
  first_corner = to;
  corner_count = count;
}

// Keeps the part where a function that is linear along the sides is <= 0 (Sutherland-Hodgman).
void cut(float at_0, float at_1, float at_2, float twist) {
  if (at_0 <= 0.0 && at_1 <= 0.0 && at_2 <= 0.0 && (!is_quad || at_1 + at_2 - at_0 + twist <= 0.0)) return;
  if (corner_count >= FEW_CORNERS) keep_few();
  if (has_few)
    cut_few(at_0, at_1, at_2, twist);
  else
    cut_many(at_0, at_1, at_2, twist);
}

void clip_by_edge(vec2 stop[3], vec2 twist, vec2 normal, float half_extent) {
  cut(dot(normal, stop[0]) - half_extent, dot(normal, stop[1]) - half_extent, dot(normal, stop[2]) - half_extent,
      dot(normal, twist));
}

// Clips by a straight bound of a normal and an extent, or by tangents of a circle of a centre and a radius. Tangents of
// a radius r >= 1 deviate from the arc by less than 3e-4 if their spacing is 0.05 over sqrt(r).
void clip_by_bound(vec2 stop[3], vec2 twist, bool straight, vec2 place, float extent) {
  vec2 middle = (is_quad ? 0.5 * (stop[1] + stop[2]) : (stop[0] + stop[1] + stop[2]) * (1.0 / 3.0)) - place;
  float half_extent = is_quad ? length(stop[1] + stop[2] - stop[0] + twist - place - middle) : 0.0;
  for (int k = 0; k < 3; ++k) half_extent = max(half_extent, length(stop[k] - place - middle));
  float distance = length(middle);
  float half_angle = distance > 1.5 * half_extent ? asin(half_extent / distance) : 3.14159265;
  float step_rad = 0.05 / sqrt(max(extent, 1.0));
  int tangents = straight ? 1 : min(1 + int(ceil(2.0 * half_angle / step_rad)), MAX_TANGENTS);
  float middle_angle = atan(middle.y, middle.x);
  for (int k = 0; k < tangents; ++k) {
    float angle = middle_angle + half_angle * (float(2 * k + 1) / float(tangents) - 1.0);
    vec2 normal = straight ? place : vec2(cos(angle), sin(angle));
    clip_by_edge(stop, twist, normal, straight ? extent : extent + dot(normal, place));
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
      bool clips = is_beyond(b, stop[0]) || is_beyond(b, stop[1]) || is_beyond(b, stop[2]);
      if (is_quad) clips = clips || is_beyond(b, stop[1] + stop[2] - stop[0] + twist_of(c));
      left |= clips ? 1u << k : 0u;
    }
    for (; left != 0u; left &= left - 1u) {
      uint b = from + uint(findLSB(left));
      vec4 line = bound_half(2u * b), circle = bound_half(2u * b + 1u);
      bool straight = !is_circle() && line.w != 0.0;
      vec2 place = is_circle() ? vec2(0.0) : straight ? line.xy : circle.xy;
      clip_by_bound(stop, twist_of(c), straight, place, is_circle() ? 1.0 : straight ? line.z : circle.z);
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

// The whole triangle or quadrilateral, in (u, v).
void begin_triangle() {
  for (int k = 0; k < FEW_CORNERS; ++k)
    few[k] = is_quad ? vec2(float(k == 1 || k == 2), float(k == 2 || k == 3)) : vec2(float(k == 1), float(k == 2));
  has_few = true;
  corner_count = is_quad ? 4 : 3;
}

void clip_by_rims() {
  cut(heights_of_triangle[0] - 1.0, heights_of_triangle[1] - 1.0, heights_of_triangle[2] - 1.0, height_twist);
}

// Leaves the open part of the triangle of rays.
void clip_triangle(uint crossing_count) {
  clip_by_rims();
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
