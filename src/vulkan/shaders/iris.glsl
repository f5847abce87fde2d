// SPDX-License-Identifier: Apache-2.0
// The iris as ghosts/iris_shape.h: bounds of eight numbers each, (nx, ny, apothem, straight, cx, cy, radius, power).
bool is_straight(uint b) { return bound_half(2u * b).w != 0.0; }
vec2 bound_normal(uint b) { return bound_half(2u * b).xy; }
float bound_apothem(uint b) { return bound_half(2u * b).z; }
vec2 bound_centre(uint b) { return bound_half(2u * b + 1u).xy; }
float bound_radius(uint b) { return bound_half(2u * b + 1u).z; }
float bound_power(uint b) { return bound_half(2u * b + 1u).w; }

float bound_distance(uint b, vec2 q) {
  vec4 line = bound_half(2u * b);
  if (line.w != 0.0) return dot(line.xy, q) - line.z;
  vec4 circle = bound_half(2u * b + 1u);
  float power = dot(q, q) - 2.0 * dot(circle.xy, q) + circle.w;
  return power / (length(q - circle.xy) + circle.z);
}

float iris_distance(vec2 q) {
  if ((p.flags & FLAG_CIRCLE) != 0u) return length(q) - 1.0;
  float largest = bound_distance(0u, q);
  for (uint b = 1u; b < p.bound_count; ++b) largest = max(largest, bound_distance(b, q));
  return largest;
}

// The largest of relative_height - 1 and the iris distances: <= 0 where a ray passes.
float blocked(uint ray, uint crossing_count) {
  float most = ray_of(ray).w - 1.0;
  for (uint c = 0u; c < crossing_count; ++c) most = max(most, iris_distance(crossing(ray, c)));
  return most;
}

// The arc of a circle within a disc. Tangents of a radius r >= 1 deviate from the arc by less than 3e-4 if their spacing
// is 0.05 over sqrt(r).
#define MAX_TANGENTS 12
struct Arc {
  float middle_angle, half_angle;
  int tangents;
};

// middle: of the disc, from that of the circle.
Arc arc_within(vec2 middle, float half_extent, float radius) {
  float distance = length(middle);
  float half_angle = distance > 1.5 * half_extent ? asin(half_extent / distance) : 3.14159265;
  float step_rad = 0.05 / sqrt(max(radius, 1.0));
  return Arc(atan(middle.y, middle.x), half_angle, min(1 + int(ceil(2.0 * half_angle / step_rad)), MAX_TANGENTS));
}

vec2 tangent_normal(Arc arc, int k) {
  float angle = arc.middle_angle + arc.half_angle * (float(2 * k + 1) / float(arc.tangents) - 1.0);
  return vec2(cos(angle), sin(angle));
}
