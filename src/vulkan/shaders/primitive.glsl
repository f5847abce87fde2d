// SPDX-License-Identifier: Apache-2.0
// The light of a primitive at a pixel's middle: render/tiled/tile_traversal.cpp and barycentric-inl.h under the same
// names. Corners are in order, so that the shoelace area is positive.
#define TRIANGLE_BY_MATRIX 0u
#define TRIANGLE_BY_CROSS_PRODUCT 1u
#define MEAN_VALUE 2u
#define WACHSPRESS 3u
#define LOOP_DEROSE 4u

// TiledOptions::Interpolation. Drivers leave out the code of the others.
layout(constant_id = 2) const uint INTERPOLATION = LOOP_DEROSE;

// The edges that block a primitive's light in part: the corners' relative heights and stop points, and by crossing of
// the stop the bits of the iris's bounds beyond which a corner lies. If all corners are within a bound, all points
// between them are.
struct Edges {
  vec4 heights;
  vec2 stops[MAX_CROSSINGS][4];
  uint bounds[MAX_CROSSINGS];
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

// The corners' weights at a pixel's middle, whose sum is 1; all 0 outside.
vec4 weights_in(vec2 corners[4], bool is_triangle, ivec2 pixel) {
  vec2 middle = vec2(pixel) + 0.5;
  vec2 s[4];
  // Without fused multiply-adds, so that an edge is exactly the negative of its neighbour's, and one without a length
  // is 0.
  precise vec4 edge;
  bool is_inside = true;
  for (int i = 0; i < 4; ++i) s[i] = corners[i] - middle;
  for (int i = 0; i < 4; ++i) {
    int j = (i + 1) % 4;
    edge[i] = s[i].x * s[j].y - s[j].x * s[i].y;
    is_inside = is_inside && is_beside(s[i], s[j], edge[i]);
  }
  vec4 w = weights_at(is_triangle ? TRIANGLE_BY_CROSS_PRODUCT : INTERPOLATION, s, edge);
  float total = (w.x + w.y) + (w.z + w.w);
  return is_inside && total > 0.0 ? w / total : vec4(0.0);
}

// The distance from one of the iris's bounds, numbered as the bits of Edges are.
float edge_distance(uint b, vec2 at) {
  return (p.flags & FLAG_CIRCLE) != 0u ? length(at) - 1.0 : bound_distance(b, at);
}
uint edge_count() { return (p.flags & FLAG_CIRCLE) != 0u ? 1u : p.bound_count; }

// The bits of the bounds beyond which one of four stop points lies.
uint bounds_about(vec2 stops[4]) {
  uint bits = 0u;
  for (uint b = 0u; b < edge_count(); ++b) {
    bool is_beyond = false;
    for (int i = 0; i < 4; ++i) is_beyond = is_beyond || !(edge_distance(b, stops[i]) <= 0.0);
    if (is_beyond) bits |= 1u << min(b, 31u);
  }
  return bits;
}

Edges edges_of(uvec4 v, uint crossing_count) {
  Edges edges;
  edges.heights = vec4(ray_of(v.x).w, ray_of(v.y).w, ray_of(v.z).w, ray_of(v.w).w);
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    for (int i = 0; i < 4; ++i) edges.stops[c][i] = c < crossing_count ? crossing(v[i], c) : vec2(0.0);
    edges.bounds[c] = 0u;
  }
  return edges;
}

bool is_blocked(Edges edges, vec4 w) {
  bool blocked = dot(w, edges.heights) > 1.0, every = edge_count() > 32u;
  for (int c = 0; c < MAX_CROSSINGS; ++c) {
    vec2 q[4] = edges.stops[c];
    vec2 at = w.x * q[0] + w.y * q[1] + w.z * q[2] + w.w * q[3];
    uint left = edges.bounds[c], count = left == 0u ? 0u : edge_count();
    for (uint k = 0u; every ? k < count : left != 0u; ++k) {
      uint b = every ? k : uint(findLSB(left));
      left &= left - 1u;
      blocked = blocked || edge_distance(b, at) > 0.0;
    }
  }
  return blocked;
}

// The pixels whose middles lie within the primitive's bounds; empty if the last is before the first.
ivec4 pixels_within(uvec4 v) {
  vec2 low = min(min(ray_of(v.x).xy, ray_of(v.y).xy), min(ray_of(v.z).xy, ray_of(v.w).xy));
  vec2 high = max(max(ray_of(v.x).xy, ray_of(v.y).xy), max(ray_of(v.z).xy, ray_of(v.w).xy));
  vec2 last = vec2(p.width, p.height) - 1.0;
  vec2 first_middle = max(ceil(low - 0.5), vec2(0.0)), last_middle = min(floor(high - 0.5), last);
  if (!(first_middle.x <= last_middle.x && first_middle.y <= last_middle.y)) return ivec4(0, 0, -1, -1);
  return ivec4(ivec2(first_middle), ivec2(last_middle));
}
