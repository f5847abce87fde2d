// SPDX-License-Identifier: Apache-2.0
// The transmittance of the stop as the mean over a square about a point, as the CPU takes it:
// render/stop_patterns/stop_pattern.cpp under the same names. Points in stop radii. Included after occluders.glsl.

// The fraction of a square that is inside a straight edge at a distance from its middle.
float sharp_transmittance(float distance, float width) {
  if (!(width > 0.0)) return distance <= 0.0 ? 1.0 : 0.0;
  return clamp(0.5 - distance / width, 0.0, 1.0);
}

// The distance from a picture's opening: IrisField::distance().
float distance_from_picture(vec2 at) {
  uint field = p.picture + 2u, table = pattern_table(field), first = after_axis(table);
  int side = int(pattern_side(field));
  float scale = 0.5 * float(side - 2);
  vec2 place = (picture_from_stop(table, at) + 1.0) * scale + 0.5, inside = clamp(place, vec2(0.0), vec2(side - 1));
  ivec2 low = min(ivec2(inside), ivec2(side - 2));
  vec2 part = inside - vec2(low);
  uint below = first + uint(low.y * side + low.x), above = below + uint(side);
  float from = mix(mix(uintBitsToFloat(patterns[below]), uintBitsToFloat(patterns[below + 1u]), part.x),
                   mix(uintBitsToFloat(patterns[above]), uintBitsToFloat(patterns[above + 1u]), part.x), part.y);
  return from + length(place - inside) / scale;
}

float distance_from_iris(vec2 at) { return HAS_PICTURE ? distance_from_picture(at) : iris_distance(at); }

float edge_over_square(uint pattern, float distance, float width) {
  float scale = pattern_scale(pattern);
  if (scale == 0.0) return sharp_transmittance(distance, width);
  return profile_at(pattern_table(pattern), -scale * distance, scale * width);
}

float edges_over_square(uint pattern, vec2 at, float width) {
  if (HAS_PICTURE || is_round_iris()) {
    float open = edge_over_square(pattern, distance_from_iris(at), width);
    return open > 0.0 ? open * tone_over_square(at, width) : 0.0;
  }
  float all = 1.0;
  for (uint b = 0u; b < p.bound_count && all > 0.0; ++b)
    all *= edge_over_square(pattern, bound_distance(b, at), width);
  return max(all, 0.0);
}

float pattern_over_square(uint pattern, vec2 at, float width) {
  return pattern_side(pattern) == 0u ? edges_over_square(pattern, at, width) : texture_at(pattern, at, width);
}

// The factor of an earlier crossing of the stop, where the iris is sharp.
float iris_over_square(vec2 at, float width) {
  float open = sharp_transmittance(distance_from_iris(at), width);
  return open > 0.0 ? open * tone_over_square(at, width) : 0.0;
}

// Says whether the picture leaves nothing of a disc, all of it, or a part.
int region_in_picture(Disc disc) {
  float distance = distance_from_picture(disc.middle);
  if (distance > disc.radius) return REGION_DARK;
  return -distance > disc.radius ? REGION_UNIFORM : REGION_VARYING;
}

// The region of a disc of the stop.
int region_of_disc(uint pattern, Disc disc) {
  vec2 middle = disc.middle;
  float radius = disc.radius;
  if (pattern_side(pattern) != 0u)
    return length(middle) - radius > pattern_outer_radius(pattern) ? REGION_DARK : REGION_VARYING;
  float scale = pattern_scale(pattern), from_edge = distance_from_iris(middle);
  if (scale == 0.0) return from_edge > radius ? REGION_DARK : REGION_VARYING;
  if (scale * (from_edge - radius) > -PROFILE_FIRST) return REGION_DARK;
  if ((p.flags & FLAG_HALF_TONES) != 0u) return REGION_VARYING;
  return scale * (-from_edge - radius) > pattern_uniform_from(pattern) ? REGION_UNIFORM : REGION_VARYING;
}

// The fraction of a square, which lies along a stroke, that the stroke covers: covered_fraction() of
// render/planning/dirt_field.cpp.
float covered_square(Stroke s, vec2 at, float width) {
  vec2 own = along_and_across(s, at - s.middle);
  if (width < 2.0 * s.half_width) {
    float beyond = max(abs(own.x) - s.half_length, 0.0), distance = length(vec2(beyond, own.y)) - s.half_width;
    if (abs(distance) > width) return distance < 0.0 ? 1.0 : 0.0;
    float inwards = beyond > 0.0 ? s.half_width - sqrt(s.half_width * s.half_width - width * width / 12.0) : 0.0;
    return sharp_transmittance(distance + inwards, width);
  }
  return overlap(own.x, 2.0 * s.half_length + 0.5 * 3.14159265 * s.half_width, width) *
         overlap(own.y, 2.0 * s.half_width, width);
}

#define MOST_SQUARES 8  // a side, of a square that is wider than a cell

// The transmittance of dirt, its shapes and its picture, as the mean over a square: DirtField::transmission(). mm.
float dirt_over_square(vec2 at, float width) {
  int parts = clamp(int(ceil(width / dirt_cell_mm())), 1, MOST_SQUARES);
  float sum = 0.0, part_width = width / float(parts);
  for (int k = 0; k < parts * parts; ++k) {
    vec2 middle = at + ((vec2(k % parts, k / parts) + 0.5) / float(parts) - 0.5) * width;
    uint cell = dirt[DIRT_FIRST_AT] + dirt_cell_of(middle.y) * dirt[DIRT_CELLS] + dirt_cell_of(middle.x);
    float left = 1.0;
    for (uint j = dirt[cell], end = dirt[cell + 1u]; j < end; ++j) {
      Stroke s = stroke_at(dirt[dirt[DIRT_OF_CELL_AT] + j]);
      left *= 1.0 - s.opacity * covered_square(s, middle, part_width);
    }
    sum += left;
  }
  float all = sum / float(parts * parts);
  return dirt[DIRT_PICTURE_AT] == 0u ? all : all * picture_transmission(at, vec2(width, 0.0), vec2(0.0, width));
}
