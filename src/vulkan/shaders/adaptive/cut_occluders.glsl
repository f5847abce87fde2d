// SPDX-License-Identifier: Apache-2.0
// The occluders of a triangle of a cut cell (occluders.glsl). Included by cut.comp.
vec2 front_of_triangle[3], stops_of_triangle[MAX_CROSSINGS][3];
uint occluders = 0u;  // mask of what may dim the triangle

// The point at which light crosses the front, for a place in the cell.
vec2 front_at(vec2 in_cell) {
  if (!has_dirt_at(POINT_FRONT, 0u)) return vec2(0.0);
  return front_point(item, entrance_at(vec2(own % side, own / side) + in_cell));
}

void set_points(uint k, out vec2 at[3]) {
  for (int j = 0; j < 3; ++j) at[j] = k == POINT_FRONT ? front_of_triangle[j] : stops_of_triangle[k][j];
}

// Sets the mask of what may dim the triangle.
void find_occluders() {
  occluders = pattern != 0u ? OCCLUDED_BY_PATTERN : 0u;
  uint sharp = pattern == 0u ? crossings_of(item) : crossings_of(item) - 1u;
  vec2 across = pixels[1] - pixels[0], down = pixels[2] - pixels[0];
  for (uint k = 0u; k < POINTS; ++k) {
    bool may_be_dirty = has_dirt_at(k, crossings_of(item)), is_in_picture = HAS_PICTURE && k < sharp;
    if (!may_be_dirty && !is_in_picture) continue;
    vec2 at[3];
    set_points(k, at);
    float pixel_extent = pixel_extent_of(across, down, at[1] - at[0], at[2] - at[0]);
    if (is_in_picture && region_of_picture(disc_of(at[0], at[1], at[2], pixel_extent)) != REGION_UNIFORM)
      occluders |= OCCLUDED_BY_PICTURE(k);
    if (may_be_dirty && is_dirty(disc_of(at[0], at[1], at[2], pixel_extent))) occluders |= OCCLUDED_BY_DIRT(k);
  }
  is_dimmed = occluders != 0u;
}

uint last_crossing() { return crossings_of(item) - 1u; }

// The mean transmittance over the clipped triangle.
float mean_transmittance() {
  float all = 1.0;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(occluders, k, last_crossing())) continue;
    vec2 at[3];
    set_points(k, at);
    Parallelogram mean = about_triangle(at);
    all *= transmittance_of_point(occluders, k, last_crossing(), pattern, ALL_EDGES, mean.at, mean.x, mean.y);
  }
  return all;
}

// Whether the pixels look up what dims the triangle.
bool is_looked_up() {
  float widest = 0.0;  // of the plane that a pixel sees
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(occluders, k, last_crossing())) continue;
    vec2 at[3];
    set_points(k, at);
    widest = max(widest, k == POINT_FRONT ? width_of(at) / dirt_float(DIRT_CLEAR_RADIUS) : width_of(at));
  }
  return is_looked_up(area_px, widest);
}

// The product of the transmittances at a place in the picture, over a part of a pixel's sides.
float product_at(vec2 place, float size) {
  float all = 1.0;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(occluders, k, last_crossing())) continue;
    vec2 at[3];
    set_points(k, at);
    PointMap map = map_to(at);
    all *= transmittance_of_point(occluders, k, last_crossing(), pattern, ALL_EDGES,
                                  map.origin + map.x * place.x + map.y * place.y, size * map.x, size * map.y);
  }
  return all;
}

// The mean transmittance over the pixel in which the triangle lies.
float pixel_transmittance() {
  vec2 middle = floor(polygon[0]) + 0.5;
  partly_covering = 0u;
  float sum = 0.0;
  for (int k = WHOLE_PIXEL; k < PARTS_OF_PIXEL * PARTS_OF_PIXEL; ++k) {
    float one = product_at(middle + part_of_pixel(k), width_of_part(k));
    if (k == WHOLE_PIXEL && !is_seen_in_parts()) return one;
    if (k != WHOLE_PIXEL) sum += one;
  }
  return sum / float(PARTS_OF_PIXEL * PARTS_OF_PIXEL);
}

// Sets the maps from pixels to all points at which something dims light.
void set_maps() {
  uint edge_bits = 0u;
  if ((occluders & OCCLUDED_BY_PATTERN) != 0u) {
    edge_bits = edges_of(map_to(last_stops));
    if (edge_bits == 0u) occluders &= ~OCCLUDED_BY_PATTERN;
  }
  map_corners = 1u;
  pattern_map[0] = vec2(uintBitsToFloat(edge_bits), uintBitsToFloat(pattern | last_crossing() << LAST_SHIFT));
  for (uint k = 0u; k < POINTS; ++k) {
    if (!needs_point(occluders, k, last_crossing())) continue;
    vec2 at[3];
    set_points(k, at);
    PointMap map = map_to(at);
    pattern_map[map_corners++] = map.x;
    pattern_map[map_corners++] = map.y;
    pattern_map[map_corners++] = map.origin;
  }
  record_pattern = occluders;
}

// Sets the maps of a polygon. Returns the transmittance of what pixels do not look up.
float set_occluders(bool is_point, bool is_line) {
  if (is_line || !is_looked_up()) return mean_transmittance();
  set_slopes();
  if (is_point) return pixel_transmittance();
  set_maps();
  return 1.0;
}
