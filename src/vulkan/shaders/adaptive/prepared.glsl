// SPDX-License-Identifier: Apache-2.0
// Draws polygons by pixel: some are prepared in shared memory, then each invocation adds them to its pixel.
shared uint others[256];
shared uint others_count;
// The polygons that are prepared.
shared vec4 edges[256];
shared uint edge_counts[32];  // 0: not prepared
shared ivec4 boxes_of_polygons[32];
shared vec3 gains[32], planes[32];

#ifdef PATTERNS
#ifdef OCCLUDERS
#define POLYGON_MAP_CORNERS 12u
#else
#define POLYGON_MAP_CORNERS 3u
#endif
shared uint patterns_of_polygons[32];  // or masks
shared vec2 maps[32u * POLYGON_MAP_CORNERS];  // of the pixels of the tile
shared uint edge_bits_of_polygons[32];
#ifdef OCCLUDERS
shared uint pattern_words[32];  // a pattern's number, and that of the last crossing

// The product of a prepared polygon's transmittances, as product_at().
float prepared_product_at(uint j, vec2 place, float size) {
  uint mask = patterns_of_polygons[j], pattern = pattern_words[j], last = pattern >> LAST_SHIFT;
  uint map = POLYGON_MAP_CORNERS * j;
  float all = 1.0;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(mask, k, last)) continue;
    vec2 x = maps[map], y = maps[map + 1u], at = maps[map + 2u] + x * place.x + y * place.y;
    all *= transmittance_of_point(mask, k, last, pattern & ~(3u << LAST_SHIFT), edge_bits_of_polygons[j], at, size * x,
                                  size * y);
    map += 3u;
  }
  return all;
}

float prepared_transmittance(uint j, vec2 place) {
  partly_covering = 0u;
  float sum = 0.0;
  for (int k = WHOLE_PIXEL; k < PARTS_OF_PIXEL * PARTS_OF_PIXEL; ++k) {
    float one = prepared_product_at(j, place + part_of_pixel(k), width_of_part(k));
    if (k == WHOLE_PIXEL && !is_seen_in_parts()) return one;
    if (k != WHOLE_PIXEL) sum += one;
  }
  return sum / float(PARTS_OF_PIXEL * PARTS_OF_PIXEL);
}

// Prepares the maps of a polygon, which begin at a corner.
void prepare_maps(uint j, uint first, vec2 middle) {
  edge_bits_of_polygons[j] = floatBitsToUint(large_corner(first).x);
  pattern_words[j] = floatBitsToUint(large_corner(first).y);
  uint mask = patterns_of_polygons[j], from = first + 1u, to = POLYGON_MAP_CORNERS * j;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(mask, k, pattern_words[j] >> LAST_SHIFT)) continue;
    vec2 x = large_corner(from), y = large_corner(from + 1u);
    maps[to] = x;
    maps[to + 1u] = y;
    maps[to + 2u] = large_corner(from + 2u) + x * middle.x + y * middle.y;
    from += 3u;
    to += 3u;
  }
}
#else
float prepared_transmittance(uint j, vec2 place) {
  vec2 x = maps[3u * j], y = maps[3u * j + 1u];
  return transmittance_at(patterns_of_polygons[j], maps[3u * j + 2u] + x * place.x + y * place.y, x, y,
                          edge_bits_of_polygons[j]);
}

void prepare_maps(uint j, uint first, vec2 middle) {
  vec2 x = large_corner(first), y = large_corner(first + 1u);
  edge_bits_of_polygons[j] = floatBitsToUint(large_corner(first + 3u).x);
  maps[3u * j] = x;
  maps[3u * j + 1u] = y;
  maps[3u * j + 2u] = large_corner(first + 2u) + x * middle.x + y * middle.y;
}
#endif
#endif

// Prepares polygons for drawing by pixel: 8 invocations a polygon, an edge each.
void prepare(uint from, uint count) {
  uint t = gl_LocalInvocationIndex, j = t / 8u, e = t % 8u;
  if (from + j >= count) return;
  uint number = others[from + j];
  Polygon q = polygon_of(number);
  uint first = first_of(q), corners = count_of(q);
  vec2 origin = vec2(tile_low - base_of(q));
  bool is_convex = corners >= 3u && corners <= 8u && !is_concave(q);
  if (e >= corners) edges[t] = vec4(0.0, 0.0, 1.0, 0.0);  // every pixel is inside
  if (is_convex && e < corners) {
    vec2 a = large_corner(first + e) - origin, b = large_corner(first + (e + 1u == corners ? 0u : e + 1u)) - origin;
    vec2 along = b - a;
    // For the middle of the tile's pixel (x, y): positive inside, above w where the whole pixel is.
    edges[t] = vec4(-along.y, along.x, along.x * (0.5 - a.y) - along.y * (0.5 - a.x), 0.5 * (abs(along.x) + abs(along.y)));
  }
  if (e != 0u) return;
  edge_counts[j] = is_convex ? corners : 0u;
  boxes_of_polygons[j] = box_of(number) - tile_low.xyxy;
  gains[j] = gain_of(q);
  planes[j] = vec3(gradient_of(q), value_of(q) + dot(gradient_of(q), origin + 0.5 - point_of(q)));
#ifdef PATTERNS
  patterns_of_polygons[j] = pattern_of(q);
  if (patterns_of_polygons[j] != 0u) prepare_maps(j, first + corners, origin + 0.5);
#endif
}

// How a pixel lies to the edges of a polygon: outside one, or across some, and the last of these.
struct Crossing {
  bool is_outside;
  uint count;
  vec3 edge;
};

void cross_edge(vec4 edge, vec2 place, inout Crossing crossing) {
  float side = dot(edge.xy, place) + edge.z;
  if (side <= -edge.w) crossing.is_outside = true;
  if (side >= edge.w) return;
  ++crossing.count;
  crossing.edge = vec3(edge.xy, side);
}

void cross_four_edges(uint first, vec2 place, inout Crossing crossing) {
  cross_edge(edges[first], place, crossing);
  cross_edge(edges[first + 1u], place, crossing);
  cross_edge(edges[first + 2u], place, crossing);
  cross_edge(edges[first + 3u], place, crossing);
}

// The value of a prepared polygon in a pixel of the tile.
float prepared_value(uint j, uint polygon, ivec2 at, ivec2 pixel) {
  ivec4 box = boxes_of_polygons[j];
  if (at.x < box.x || at.y < box.y || at.x > box.z || at.y > box.w) return 0.0;
  uint count = edge_counts[j];
  if (count == 0u) return value_at(polygon, pixel);
  vec2 place = vec2(at);
  Crossing crossing = Crossing(false, 0u, vec3(0.0));
  cross_four_edges(8u * j, place, crossing);
  if (count > 4u) cross_four_edges(8u * j + 4u, place, crossing);
  if (crossing.is_outside) return 0.0;
  if (crossing.count > 1u) return value_at(polygon, pixel);
  float covered = crossing.count == 0u ? 1.0 : half_plane(crossing.edge.xy, crossing.edge.z);
#ifdef PATTERNS
  if (patterns_of_polygons[j] != 0u) covered *= prepared_transmittance(j, place);
#endif
  return covered * (dot(planes[j].xy, place) + planes[j].z);
}

// Draws the listed others, one pixel an invocation.
void draw_others(ivec2 at) {
  uint count = others_count;
  for (uint chunk = 0u; chunk < count; chunk += 32u) {
    prepare(chunk, count);
    barrier();
    uint j = 0u, prepared = min(32u, count - chunk);
    for (; j < prepared; ++j) {
      float value = prepared_value(j, others[chunk + j], at, tile_low + at);
      if (value != 0.0) add(0, value, gains[j]);
    }
    check_end(j, prepared);
    barrier();
  }
}
