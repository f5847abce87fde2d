// SPDX-License-Identifier: Apache-2.0
// A cell of a grid of rays: render/bundle/cell_raster.cpp under the same names. Included after polygon.glsl.
#define SHADED_CELL_PX 4.0
#define SLIVER 1e-7
#define NEGLIGIBLE_COVERAGE 1e-6  // of a pixel: rounding error outside a polygon
#define STATE_CLOSED 0
#define STATE_CUT 1
#define STATE_OPEN 2

struct Density {
  vec2 point;  // relative to base
  float value;
  vec2 gradient;
};

ivec2 base;  // a pixel near the cell: coordinates relative to it keep their digits

vec2 pixel_of(uint ray) { return ray_of(ray).xy - vec2(base); }

bool outside_frame(uvec4 v) {
  vec2 low = min(min(ray_of(v.x).xy, ray_of(v.y).xy), min(ray_of(v.z).xy, ray_of(v.w).xy));
  vec2 high = max(max(ray_of(v.x).xy, ray_of(v.y).xy), max(ray_of(v.z).xy, ray_of(v.w).xy));
  return !(low.x < float(p.width) && low.y < float(p.height) && high.x >= 0.0 && high.y >= 0.0);
}

bool in_one_pixel() {
  for (int k = 1; k < corner_count; ++k)
    if (floor(polygon[k]) != floor(polygon[0])) return false;
  return true;
}

void farthest_corners(out vec2 from, out vec2 to) {
  from = polygon[0];
  to = polygon[0];
  float longest = 0.0;
  for (int i = 0; i < corner_count; ++i) {
    for (int j = 0; j < i; ++j) {
      vec2 between = polygon[i] - polygon[j];
      if (dot(between, between) > longest) {
        longest = dot(between, between);
        from = polygon[j];
        to = polygon[i];
      }
    }
  }
}

bool is_convex(vec2 a, vec2 b, vec2 c, vec2 d, float orientation) {
  return cross2(b - a, c - a) * orientation > 0.0 && cross2(c - b, d - b) * orientation > 0.0 &&
         cross2(d - c, a - c) * orientation > 0.0 && cross2(a - d, b - d) * orientation > 0.0;
}

// The centroid of a quadrilateral that is convex: the mean of a plane over it is the plane's value there.
vec2 centroid_of(vec2 a, vec2 b, vec2 c, vec2 d) {
  float first = cross2(b - a, c - a), second = cross2(c - a, d - a);
  return a + (c - a + ((b - a) * first + (d - a) * second) / (first + second)) / 3.0;
}

// The plane whose differences along both diagonals are those of the irradiances at the corners, relative to their mean.
vec2 gradient_along(vec2 first_diagonal, vec2 second_diagonal, vec4 e) {
  float mean = 0.25 * (e.x + e.y + e.z + e.w), first = (e.z - e.x) / mean, second = (e.w - e.y) / mean;
  vec2 d = first_diagonal, f = second_diagonal;
  return vec2(first * f.y - second * d.y, second * d.x - first * f.x) / cross2(d, f);
}
vec2 gradient_of(uvec4 v, vec4 e) {
  return gradient_along(ray_of(v.z).xy - ray_of(v.x).xy, ray_of(v.w).xy - ray_of(v.y).xy, e);
}
