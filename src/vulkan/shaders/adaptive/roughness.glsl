// SPDX-License-Identifier: Apache-2.0
// The edges and fringes within a ghost: of stop patterns, of dirt and of a picture as the iris, as measure.comp counts
// them.

// The mean squared slope of a stop pattern by pixel, where its light is 1. Fringes finer than a pixel do not show:
// along an edge they begin a pixel's part of a fringe unit from it.
float roughness_px(Cell cell) {
  uint k = gl_LocalInvocationIndex;
  float stop_area = abs(cross2(last_stop(k + 17u) - last_stop(k), last_stop(k + 16u) - last_stop(k + 1u)));
  float across = sqrt(min(0.5 * stop_area / max(abs(cell.area_px), 1.0), 1.0));  // a pixel, in stop radii
  float rough = pattern_roughness(pattern);
  if (pattern_side(pattern) != 0u) return min(rough * across * across, LARGEST_ROUGHNESS);
  float unit = pattern_scale(pattern) * across;  // a pixel, in fringe units
  return 2.0 * across * min(rough * unit, 1.0 + unit) * min(cell.open, 1.0);
}

// The points of a ray in the plane that a map leads to.
vec2 seen_point(uint k, bool is_dirt) {
#ifdef OCCLUDERS
  if (is_dirt) return dirt_point(k);
#endif
  return last_stop(k);
}

vec2 seen_difference(uint k, uint step_by, bool is_dirt) {
  return seen_point(k - step_by, is_dirt) - 2.0 * seen_point(k, is_dirt) + seen_point(k + step_by, is_dirt);
}

// The squared displacement, in pixels, of what a stop pattern or dirt shows by the bends of the maps to the frame and
// to its plane.
float squared_bend_of_map(uint k, bool is_dirt) {
  uint inside = ray_inside();
  if (!has_neighbours_in_row() || !has_neighbours_in_column()) return 1.0;
  vec2 px = corners_along_row(), py = corners_along_column();
  vec2 sa = seen_point(k, is_dirt), sb = seen_point(k + 1u, is_dirt);
  vec2 sc = seen_point(k + 17u, is_dirt), sd = seen_point(k + 16u, is_dirt);
  vec2 sx = sb - sa + sc - sd, sy = sd - sa + sc - sb;
  float det = cross2(sx, sy), sum = 0.0;
  if (det == 0.0) return 1.0;
  for (uint axis = 0u; axis < 2u; ++axis) {
    uint by = axis == 0u ? 1u : 16u;
    vec2 of_stop = seen_difference(inside, by, is_dirt);
    vec2 of_pixel = axis == 0u ? bend_of_row() : bend_of_column();
    vec2 off = (px * cross2(of_stop, sy) + py * cross2(sx, of_stop)) / det - of_pixel;
    sum += dot(off, off) / 64.0;
  }
  return min(sum, 1.0);
}

#ifdef OCCLUDERS
// The same as roughness_px() for the edges of dirt's shadows: their squared contrast and length, by pixel.
float dirt_roughness_px(Cell cell) {
  uint k = gl_LocalInvocationIndex;
  if ((p.flags & (FLAG_DIRT_IN_STOP | FLAG_DIRT_ON_FRONT)) == 0u) return 0.0;
  vec2 a = dirt_point(k), b = dirt_point(k + 1u), c = dirt_point(k + 17u), d = dirt_point(k + 16u);
  Disc disc = disc_of(a, b, c, d, 0.0);
  if (is_clean(disc.middle, disc.radius)) return 0.0;
  float pixel_mm = sqrt(0.5 * abs(cross2(c - a, d - b)) / max(abs(cell.area_px), 1.0));
  return cell.open * min(dirt_float(DIRT_EDGES_PER_MM) * pixel_mm, LARGEST_ROUGHNESS);
}
#endif

#ifdef OCCLUDERS
// The same for a picture as the iris, whose edges are sharp.
float picture_roughness_px(Cell cell) {
  uint k = gl_LocalInvocationIndex;
  if (!HAS_PICTURE || pattern != 0u) return 0.0;
  float stop_area = abs(cross2(last_stop(k + 17u) - last_stop(k), last_stop(k + 16u) - last_stop(k + 1u)));
  float across = sqrt(min(0.5 * stop_area / max(abs(cell.area_px), 1.0), 1.0));
  float sample_width = 2.0 * pattern_scale(p.picture) / float(pattern_side(p.picture));
  return min(pattern_roughness(p.picture) * sample_width * across, LARGEST_ROUGHNESS);
}
#endif
