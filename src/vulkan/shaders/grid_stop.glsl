// SPDX-License-Identifier: Apache-2.0
// What dims a grid's light at the stop and on the front besides rims and a sharp iris:
// render/stop_patterns/stop_transmittance.cpp under the same names. Included after iris.glsl and coverage.glsl.
#include "stop/tables.glsl"
#include "stop/pattern.glsl"
#include "stop/occluders.glsl"
#include "stop/squares.glsl"
layout(set = 0, binding = 42) uniform usamplerBuffer grid_texels;  // four a grid, GridRecord

#define DISC_OF_CORNERS 1.5  // over the corners' distance from the middle: cells may be curved

// Bits of what dims a cell.
#define DIMMED_BY_PATTERN 1u
#define DIMMED_BY_DIRT 2u
#define DIMMED_TO_NOTHING 4u

// The present grid.
uint grid_pattern, grid_first_ray, grid_side;
float grid_outer_radius;  // of which crossings of the stop are multiples, stop radii

void set_grid(uint grid) {
  uvec4 words = texelFetch(grid_texels, int(4u * grid));
  grid_pattern = words.x;
  grid_outer_radius = uintBitsToFloat(words.y);
  grid_first_ray = words.z;
  grid_side = words.w;
}

vec2 stop_point(uint ray, uint c) { return crossing(ray, c) * grid_outer_radius; }

// What dims the cell of four rays in order. If a ray has failed, the pattern counts as varying, and the cell as dirty.
uint dimming_of(uvec4 v, uint crossing_count, bool any_failed) {
  uint dims = 0u;
  if (grid_pattern != 0u && crossing_count > 0u) {
    uint last = crossing_count - 1u;
    vec2 q[4];
    for (int k = 0; k < 4; ++k) q[k] = stop_point(v[k], last);
    vec2 middle = 0.25 * (q[0] + q[1] + q[2] + q[3]);
    float radius = 0.0;
    for (int k = 0; k < 4; ++k) radius = max(radius, length(q[k] - middle));
    int region = any_failed ? REGION_VARYING : region_of_disc(grid_pattern, middle, DISC_OF_CORNERS * radius);
    if (region == REGION_DARK) return DIMMED_TO_NOTHING;
    if (region == REGION_VARYING || last > 0u) dims |= DIMMED_BY_PATTERN;  // the iris is sharp at earlier crossings
  }
  return dims;
}

// The triangle whose pixels are looked up: its corners in pixels, where they cross the stop, and its area.
vec2 seen_pixels[3];
vec2 seen_stops[MAX_CROSSINGS][3];
float seen_px;
uint seen_crossings;

void see_triangle(uvec3 t, uint crossing_count, vec2 origin) {
  for (int k = 0; k < 3; ++k) {
    seen_pixels[k] = ray_of(t[k]).xy - origin;
    for (uint c = 0u; c < MAX_CROSSINGS; ++c) seen_stops[c][k] = c < crossing_count ? stop_point(t[k], c) : vec2(0.0);
  }
  seen_px = abs(0.5 * cross2(seen_pixels[1] - seen_pixels[0], seen_pixels[2] - seen_pixels[0]));
  seen_crossings = crossing_count;
}

// The position of a pixel in the triangle, (u, v) from its first corner; for a pixel outside, the nearest point in these
// coordinates.
vec2 pixel_in_triangle(vec2 pixel) {
  vec2 u = seen_pixels[1] - seen_pixels[0], v = seen_pixels[2] - seen_pixels[0], q = pixel - seen_pixels[0];
  float determinant = cross2(u, v);
  if (determinant == 0.0) return vec2(1.0 / 3.0);
  vec2 place = max(vec2(cross2(q, v), cross2(u, q)) / determinant, vec2(0.0));
  return place / max(place.x + place.y, 1.0);
}

// What is transmitted about a point in the triangle, as the mean over a pixel or, if that is smaller, the triangle.
float transmitted_at(uint dims, vec2 pixel) {
  vec2 place = pixel_in_triangle(pixel);
  float all = 1.0;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= seen_crossings) break;
    vec2 u = seen_stops[c][1] - seen_stops[c][0], v = seen_stops[c][2] - seen_stops[c][0];
    vec2 at = seen_stops[c][0] + u * place.x + v * place.y;
    float width = sqrt(0.5 * abs(cross2(u, v)) / max(seen_px, 1.0));
    if ((dims & DIMMED_BY_PATTERN) != 0u)
      all *= c + 1u == seen_crossings ? pattern_over_square(grid_pattern, at, width)
                                      : sharp_transmittance(distance_from_iris(at), width);
  }
  return all;
}
