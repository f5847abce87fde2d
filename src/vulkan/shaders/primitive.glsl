// SPDX-License-Identifier: Apache-2.0
// The light of a primitive at a pixel's middle: render/tiled/tile_traversal.cpp and barycentric-inl.h under the same
// names. Corners are in order, so that the shoelace area is positive.
#define TRIANGLE_BY_MATRIX 0u
#define TRIANGLE_BY_CROSS_PRODUCT 1u
#define MEAN_VALUE 2u
#define WACHSPRESS 3u
#define LOOP_DEROSE 4u

struct Primitive {
  uvec4 v;  // rays
  vec4 irradiance;
  bool is_triangle, is_open;
};

vec4 weights_of_triangles(vec2 s[4], vec4 edge) {
  float diagonal = s[2].x * s[0].y - s[0].x * s[2].y;
  bool is_second = diagonal < 0.0;
  return vec4(is_second ? edge.z : edge.y, is_second ? 0.0 : diagonal, is_second ? edge.w : edge.x,
              is_second ? -diagonal : 0.0);
}

vec4 weights_by_mean_value(vec2 s[4], vec4 edge) {
  vec4 r, tangent, w;
  for (int i = 0; i < 4; ++i) r[i] = length(s[i]);
  for (int i = 0; i < 4; ++i) {
    int j = (i + 1) % 4;
    float product = r[i] * r[j], d = dot(s[i], s[j]);
    bool is_acute = d > 0.0;
    tangent[i] = (is_acute ? edge[i] : product - d) / max(is_acute ? product + d : edge[i], 1e-30);
  }
  for (int i = 0; i < 4; ++i)
    w[i] = r[i] < 1e-12 ? 1e30 : (tangent[(i + 3) % 4] + tangent[i]) / max(r[i], 1e-12);
  return w;
}

vec4 weights_by_areas(vec2 s[4], vec4 edge, bool with_corners) {
  vec4 w;
  for (int i = 0; i < 4; ++i) {
    int before = (i + 3) % 4, after = (i + 1) % 4;
    vec2 a = s[i] - s[before], b = s[after] - s[i];
    float corner = with_corners ? a.x * b.y - b.x * a.y : 1.0;
    w[i] = corner * (edge[(i + 1) % 4] * edge[(i + 2) % 4]);
  }
  return w;
}

vec4 weights_at(uint method, vec2 s[4], vec4 edge) {
  if (method == MEAN_VALUE) return weights_by_mean_value(s, edge);
  if (method == WACHSPRESS || method == LOOP_DEROSE) return weights_by_areas(s, edge, method == WACHSPRESS);
  return weights_of_triangles(s, edge);
}

// An edge includes the points on it if it runs upwards, or horizontally to the left, so that a shared edge belongs to
// exactly one of two neighbours.
bool is_beside(vec2 from, vec2 to, float edge) {
  bool holds = to.y < from.y || (to.y == from.y && to.x <= from.x);
  return holds ? edge >= 0.0 : edge > 0.0;
}

// The flux of a pixel; 0 where the primitive does not contain its middle, or the light is blocked there.
float light_at(Primitive q, ivec2 pixel, uint crossing_count) {
  vec2 middle = vec2(pixel) + 0.5;
  vec2 s[4];
  vec4 w;
  // Without fused multiply-adds, so that an edge is exactly the negative of its neighbour's, and one without a length is 0.
  precise vec4 edge;
  for (int i = 0; i < 4; ++i) s[i] = rays[q.v[i]].xy - middle;
  for (int i = 0; i < 4; ++i) {
    int j = (i + 1) % 4;
    edge[i] = s[i].x * s[j].y - s[j].x * s[i].y;
    if (!is_beside(s[i], s[j], edge[i])) return 0.0;
  }
  uint method = q.is_triangle ? TRIANGLE_BY_CROSS_PRODUCT : p.flags >> FLAG_METHOD_SHIFT;
  w = weights_at(method, s, edge);
  float total = (w.x + w.y) + (w.z + w.w);
  if (!(total > 0.0)) return 0.0;
  w /= total;
  if (!q.is_open) {
    if (dot(w, vec4(rays[q.v.x].w, rays[q.v.y].w, rays[q.v.z].w, rays[q.v.w].w)) > 1.0) return 0.0;
    for (uint c = 0u; c < crossing_count; ++c) {
      vec2 at = w.x * crossing(q.v.x, c) + w.y * crossing(q.v.y, c) + w.z * crossing(q.v.z, c) + w.w * crossing(q.v.w, c);
      if (iris_distance(at) > 0.0) return 0.0;
    }
  }
  return dot(w, q.irradiance);
}

// The pixels whose middles lie within the primitive's bounds; empty if the last is before the first.
ivec4 pixels_within(uvec4 v) {
  vec2 low = min(min(rays[v.x].xy, rays[v.y].xy), min(rays[v.z].xy, rays[v.w].xy));
  vec2 high = max(max(rays[v.x].xy, rays[v.y].xy), max(rays[v.z].xy, rays[v.w].xy));
  vec2 last = vec2(p.width, p.height) - 1.0;
  vec2 first_middle = max(ceil(low - 0.5), vec2(0.0)), last_middle = min(floor(high - 0.5), last);
  if (!(first_middle.x <= last_middle.x && first_middle.y <= last_middle.y)) return ivec4(0, 0, -1, -1);
  return ivec4(ivec2(first_middle), ivec2(last_middle));
}
