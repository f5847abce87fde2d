// SPDX-License-Identifier: Apache-2.0
// What the stop pattern transmits as the mean over a square about a point, as the CPU takes it:
// render/stop_patterns/stop_pattern.cpp under the same names. Points in stop radii. Included after occluders.glsl.

// The fraction of a square that is inside a straight edge at a distance from its middle.
float sharp_transmittance(float distance, float width) {
  if (!(width > 0.0)) return distance <= 0.0 ? 1.0 : 0.0;
  return clamp(0.5 - distance / width, 0.0, 1.0);
}

// The distance from a picture's opening, also beyond its samples, where fringes reach.
float distance_from_picture(vec2 at) {
  uint distances = p.picture + 1u;
  float scale = pattern_scale(distances), last = scale - scale / float(pattern_side(distances));
  vec2 nearest = clamp(at, vec2(-last), vec2(last));
  return bilinear(pattern_table(distances), int(pattern_side(distances)), scale, nearest) + length(at - nearest);
}

float distance_from_iris(vec2 at) { return HAS_PICTURE ? distance_from_picture(at) : iris_distance(at); }

float edge_over_square(uint pattern, float distance, float width) {
  float scale = pattern_scale(pattern);
  return profile_at(pattern_table(pattern), -scale * distance, scale * width);
}

float edges_over_square(uint pattern, vec2 at, float width) {
  if (HAS_PICTURE || is_round_iris()) return max(edge_over_square(pattern, distance_from_iris(at), width), 0.0);
  float all = 1.0;
  for (uint b = 0u; b < p.bound_count && all > 0.0; ++b)
    all *= edge_over_square(pattern, bound_distance(b, at), width);
  return max(all, 0.0);
}

float pattern_over_square(uint pattern, vec2 at, float width) {
  return pattern_side(pattern) == 0u ? edges_over_square(pattern, at, width) : texture_at(pattern, at, width);
}

// The region of a disc of the stop.
int region_of_disc(uint pattern, Disc disc) {
  vec2 middle = disc.middle;
  float radius = disc.radius;
  if (pattern_side(pattern) != 0u)
    return length(middle) - radius > pattern_outer_radius(pattern) ? REGION_DARK : REGION_VARYING;
  float scale = pattern_scale(pattern), from_edge = distance_from_iris(middle);
  if (scale * (from_edge - radius) > -PROFILE_FIRST) return REGION_DARK;
  return scale * (-from_edge - radius) > pattern_uniform_from(pattern) ? REGION_UNIFORM : REGION_VARYING;
}
