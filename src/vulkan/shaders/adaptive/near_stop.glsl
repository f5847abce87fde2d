// SPDX-License-Identifier: Apache-2.0
// Whether light may pass the stop somewhere in a cell of rays, from where the rays of its corners cross it. The corners'
// points are compared, not their distances from the stop: around an opening smaller than a cell all four are alike.
float distance_to_edge(vec2 a, vec2 b) {
  vec2 along = b - a;
  float t = clamp(-dot(a, along) / max(dot(along, along), 1e-30), 0.0, 1.0);
  return length(a + t * along);
}

bool holds_origin(vec2 a, vec2 b, vec2 c) {
  vec3 sides = vec3(cross2(a, b), cross2(b, c), cross2(c, a));
  return all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
}

// The corners in order, in stop radii. The stop counts as its circumscribed circle, or the one of its pattern.
bool near_stop(vec2 q[4], float radius) {
  if (holds_origin(q[0], q[1], q[2]) || holds_origin(q[0], q[2], q[3])) return true;
  float nearest = FAILED, longest = 0.0;
  for (int k = 0; k < 4; ++k) {
    nearest = min(nearest, distance_to_edge(q[k], q[(k + 1) % 4]));
    longest = max(longest, length(q[(k + 1) % 4] - q[k]));
  }
  // The map is not linear: the corners show its mixed term, and others are about as large.
  float bend = length(q[0] - q[1] + q[2] - q[3]) + 0.1 * longest;
  return nearest <= radius + bend;
}
