// SPDX-License-Identifier: Apache-2.0
// The polygon of an invocation: in (u, v) of what is clipped, then in pixels relative to a base.
#define MAX_CORNERS 40

vec2 polygon[2 * MAX_CORNERS];  // while it is cut (cut_polygon.glsl) it may lie in the upper half
int corner_count;

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
