// SPDX-License-Identifier: Apache-2.0
// The part of a primitive's light that the stop pattern, a picture as the iris and dirt leave at a pixel's middle:
// render/tiled/tile_traversal.cpp, behind_stop(). Included after primitive.glsl and grid_stop.glsl.

float area_of(vec2 q[4]) { return 0.5 * abs(cross2(q[2] - q[0], q[3] - q[1])); }

vec2 between_corners(vec2 q[4], vec4 w) { return w.x * q[0] + w.y * q[1] + w.z * q[2] + w.w * q[3]; }

// corners: in pixels; v: their rays, of the present grid.
float behind_stop(vec2 corners[4], uvec4 v, vec4 w, uint crossing_count) {
  float all = 1.0, pixels = max(area_of(corners), 1.0);
  for (uint k = 0u; k < POINTS; ++k) {
    bool has_pattern = grid_pattern != 0u && k < crossing_count, has_dirt = has_dirt_at(k, crossing_count);
    if (!has_pattern && !has_dirt) continue;
    vec2 q[4];
    for (int i = 0; i < 4; ++i) q[i] = point_of_ray(v[i], k);
    vec2 at = between_corners(q, w);
    float width = sqrt(area_of(q) / pixels);
    if (has_pattern)
      all *= k + 1u == crossing_count ? pattern_over_square(grid_pattern, at, width) : iris_over_square(at, width);
    if (!has_dirt) continue;
    float mm = dirt_float(DIRT_MM_A_UNIT);
    all *= dirt_over_square(at * mm, width * mm);
  }
  return all;
}

// Whether a rim, or the sharp iris of a grid without a pattern, blocks the light.
bool is_blocked_at(Edges edges, vec4 w, uint crossing_count) {
  if (grid_pattern != 0u) return dot(w, edges.heights) > 1.0;
  if (is_blocked(edges, w)) return true;
  bool blocked = false;
  for (uint c = 0u; HAS_PICTURE && c < crossing_count; ++c)
    blocked = blocked || distance_from_picture(between_corners(edges.stops[c], w)) > 0.0;
  return blocked;
}
