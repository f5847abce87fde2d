// SPDX-License-Identifier: Apache-2.0
// Clips a triangle of rays by the outline of a picture as the iris. The triangle is divided into parts so small that
// the outline is about straight in each: along it the signed distance, linear between a part's corners, is 0. On the
// CPU render/bundle/cell_clip.cpp clips by the outline's pieces. Included after clip_triangle.glsl and grid_stop.glsl.
#define STRAIGHT_OUTLINE 0.01  // stop radii of a part's sides
#define VISIBLE_OUTLINE 0.3    // pixels of them
#define MOST_PICTURE_PARTS 8   // a side

// The parts a side of the triangle.
int picture_parts(vec2 pixels[3], uint crossing_count) {
  float longest = 0.0, longest_px = 0.0;
  for (int k = 0; k < 3; ++k) {
    int next = k == 2 ? 0 : k + 1;
    longest_px = max(longest_px, length(pixels[next] - pixels[k]));
    for (uint c = 0u; c < crossing_count; ++c)
      longest = max(longest, length(stops_of_triangle[c][next] - stops_of_triangle[c][k]));
  }
  return clamp(int(ceil(min(longest / STRAIGHT_OUTLINE, longest_px / VISIBLE_OUTLINE))), 1, MOST_PICTURE_PARTS);
}

// The corner that part k begins at, in (u, v) of the triangle, and the part's sides, which are (size, 0) and (0, size).
// The parts of the triangle's upper half of squares have negative sizes.
void find_part(int k, int parts, out vec2 corner, out float size) {
  int lower = parts * (parts + 1) / 2, row = 0;
  bool is_upper = k >= lower;
  int left = is_upper ? k - lower : k, count = is_upper ? parts - 1 : parts;
  for (; left >= count; --count, ++row) left -= count;
  size = 1.0 / float(parts);
  corner = vec2(left, row) * size;
  if (!is_upper) return;
  corner += size;
  size = -size;
}

void begin_part(vec2 corner, float size) {
  for (int k = 0; k < FEW_CORNERS; ++k) few[k] = corner + size * vec2(float(k == 1), float(k == 2));
  has_few = true;
  corner_count = 3;
}

// Keeps where a function that is linear over a part is <= 0, from its values at the part's corners.
void cut_part(vec3 values, vec2 corner, float size) {
  vec2 slope = (values.yz - values.x) / size;
  float at_0 = values.x - dot(slope, corner);
  cut(at_0, at_0 + slope.x, at_0 + slope.y);
}

void clip_by_picture(uint c, vec2 corner, float size) {
  vec2 u = stops_of_triangle[c][1] - stops_of_triangle[c][0], v = stops_of_triangle[c][2] - stops_of_triangle[c][0];
  vec2 at = stops_of_triangle[c][0] + u * corner.x + v * corner.y;
  cut_part(vec3(distance_from_picture(at), distance_from_picture(at + size * u), distance_from_picture(at + size * v)),
           corner, size);
}
