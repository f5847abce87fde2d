// SPDX-License-Identifier: Apache-2.0
// Values in a square from those at its corners, in order, and from the second differences along its sides, each from a
// corner to the next: bilinear, less a parabola along each side.
struct Patch4 {
  vec4 corners[4], bends[4];
};
struct Patch {
  vec2 corners[4], bends[4];
};

// The weights of the corners; half the heights of the parabolas along rows and columns.
vec4 corner_weights(vec2 at) {
  return vec4((1.0 - at.x) * (1.0 - at.y), at.x * (1.0 - at.y), at.x * at.y, (1.0 - at.x) * at.y);
}
vec2 parabolas(vec2 at) { return 0.5 * at * (1.0 - at); }

vec4 bilinear(Patch4 q, vec2 at) {
  vec4 w = corner_weights(at);
  return w.x * q.corners[0] + w.y * q.corners[1] + w.z * q.corners[2] + w.w * q.corners[3];
}
vec4 bend_along_row(Patch4 q, vec2 at) { return parabolas(at).x * mix(q.bends[0], q.bends[2], at.y); }
vec4 bend_along_column(Patch4 q, vec2 at) { return parabolas(at).y * mix(q.bends[3], q.bends[1], at.x); }

vec2 bilinear(Patch q, vec2 at) {
  vec4 w = corner_weights(at);
  return w.x * q.corners[0] + w.y * q.corners[1] + w.z * q.corners[2] + w.w * q.corners[3];
}
vec2 value_at(Patch q, vec2 at) {
  vec2 t = parabolas(at);
  return bilinear(q, at) - t.x * mix(q.bends[0], q.bends[2], at.y) - t.y * mix(q.bends[3], q.bends[1], at.x);
}

Patch first_two(Patch4 q) {
  Patch two;
  for (int k = 0; k < 4; ++k) {
    two.corners[k] = q.corners[k].xy;
    two.bends[k] = q.bends[k].xy;
  }
  return two;
}
