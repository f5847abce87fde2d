// SPDX-License-Identifier: Apache-2.0
// The iris as ghosts/iris_shape.h: bounds of eight numbers each, (nx, ny, apothem, straight, cx, cy, radius, power).
bool is_straight(uint b) { return bounds[8u * b + 3u] != 0.0; }
vec2 bound_normal(uint b) { return vec2(bounds[8u * b], bounds[8u * b + 1u]); }
float bound_apothem(uint b) { return bounds[8u * b + 2u]; }
vec2 bound_centre(uint b) { return vec2(bounds[8u * b + 4u], bounds[8u * b + 5u]); }
float bound_radius(uint b) { return bounds[8u * b + 6u]; }
float bound_power(uint b) { return bounds[8u * b + 7u]; }

float bound_distance(uint b, vec2 q) {
  if (is_straight(b)) return dot(bound_normal(b), q) - bound_apothem(b);
  vec2 from = q - bound_centre(b);
  float power = dot(q, q) - 2.0 * dot(bound_centre(b), q) + bound_power(b);
  return power / (length(from) + bound_radius(b));
}

float iris_distance(vec2 q) {
  if ((p.flags & FLAG_CIRCLE) != 0u) return length(q) - 1.0;
  float largest = bound_distance(0u, q);
  for (uint b = 1u; b < p.bound_count; ++b) largest = max(largest, bound_distance(b, q));
  return largest;
}

// The largest of relative_height - 1 and the iris distances: <= 0 where a ray passes.
float blocked(uint ray, uint crossing_count) {
  float most = rays[ray].w - 1.0;
  for (uint c = 0u; c < crossing_count; ++c) most = max(most, iris_distance(crossing(ray, c)));
  return most;
}
