// SPDX-License-Identifier: Apache-2.0
// The factors by which the stop and the front dim a grid's light, besides rims and a sharp iris:
// render/stop_patterns/stop_transmittance.cpp under the same names. Included after iris.glsl and coverage.glsl.
#include "stop/tables.glsl"
#include "stop/pattern.glsl"
#include "stop/occluders.glsl"
#include "stop/squares.glsl"
layout(set = 0, binding = 39) uniform usamplerBuffer grid_texels;  // four a grid, GridRecord

#define DISC_OF_CORNERS 1.5  // over the corners' distance from the middle: cells may be curved

// Bits: the kinds of things that dim a cell.
#define DIMMED_BY_PATTERN 1u
#define DIMMED_BY_DIRT 2u      // a picture of dirt, or dense dirt
#define CLIPPED_BY_PICTURE 4u  // as the iris, with a sharp outline
#define CUT_BY_DIRT 8u         // shapes of dirt, whose shadows are polygons
#define DIMMED_TO_NOTHING 16u

// The present grid.
uint present_grid, grid_pattern, grid_first_ray, grid_side;
float grid_outer_radius;  // of which crossings of the stop are multiples, stop radii

void set_grid(uint grid) {
  uvec4 words = texelFetch(grid_texels, int(4u * grid));
  present_grid = grid;
  grid_pattern = words.x;
  grid_outer_radius = uintBitsToFloat(words.y);
  grid_first_ray = words.z;
  grid_side = words.w;
}

vec2 stop_point(uint ray, uint c) { return crossing(ray, c) * grid_outer_radius; }

// The disc about the points of a cell's corners.
Disc disc_about(vec2 q[4]) {
  vec2 middle = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  float radius = 0.0;
  for (int k = 0; k < 4; ++k) radius = max(radius, length(q[k] - middle));
  return Disc(middle, DISC_OF_CORNERS * radius);
}

// The point at which the ray crosses the front, mm: DirtSite::front_point().
vec2 front_point(uint ray, uint grid) {
  uvec4 window = texelFetch(grid_texels, int(4u * grid + 1u)), light = texelFetch(grid_texels, int(4u * grid + 2u));
  float gap = uintBitsToFloat(texelFetch(grid_texels, int(4u * grid + 3u)).x);
  uint own = ray - grid_first_ray;
  vec2 from = vec2(own % grid_side, own / grid_side) * uintBitsToFloat(window.zw);
  vec3 along = uintBitsToFloat(light.xyz);
  along.xy += from * uintBitsToFloat(light.w);
  return uintBitsToFloat(window.xy) + from + along.xy * (gap / along.z);
}

vec2 point_of_ray(uint ray, uint k) { return k == POINT_FRONT ? front_point(ray, present_grid) : stop_point(ray, k); }

// The bit of how dirt dims the cell of four rays in order.
uint dirt_of_cell(uvec4 v, uint crossing_count, bool any_failed) {
  bool dirty = false;
  for (uint k = 0u; k < POINTS; ++k) {
    if (!has_dirt_at(k, crossing_count)) continue;
    vec2 q[4];
    for (int j = 0; j < 4; ++j) q[j] = point_of_ray(v[j], k);
    dirty = dirty || any_failed || is_dirty(disc_about(q));
  }
  if (!dirty) return 0u;
  return (p.flags & FLAG_DIRT_BY_SQUARES) != 0u ? DIMMED_BY_DIRT : CUT_BY_DIRT;
}

// The bits of the cell of four rays in order. If a ray has failed, patterns count as varying, and the cell as dirty.
uint dimming_of(uvec4 v, uint crossing_count, bool any_failed) {
  uint dims = 0u;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= crossing_count) break;
    vec2 q[4];
    for (int k = 0; k < 4; ++k) q[k] = stop_point(v[k], c);
    Disc disc = disc_about(q);
    if (grid_pattern != 0u) {
      if (c + 1u < crossing_count) {
        dims |= DIMMED_BY_PATTERN;  // the iris is sharp here
        continue;
      }
      int region = any_failed ? REGION_VARYING : region_of_disc(grid_pattern, disc);
      if (region == REGION_DARK) return DIMMED_TO_NOTHING;
      if (region == REGION_VARYING) dims |= DIMMED_BY_PATTERN;
    } else if (HAS_PICTURE) {
      int region = any_failed ? REGION_VARYING : region_in_picture(disc);
      if (region == REGION_DARK) return DIMMED_TO_NOTHING;
      if (region == REGION_VARYING) dims |= CLIPPED_BY_PICTURE;
    }
  }
  return dims | dirt_of_cell(v, crossing_count, any_failed);
}

// The triangle whose pixels are looked up: its corners in pixels, their points in the stop and on the front, its area.
vec2 seen_pixels[3];
vec2 seen_points[POINTS][3];  // stop radii, or mm on the front
float seen_px;
uint seen_crossings;

void see_triangle(uvec3 t, uint crossing_count, vec2 origin) {
  for (int k = 0; k < 3; ++k) {
    seen_pixels[k] = ray_of(t[k]).xy - origin;
    for (uint c = 0u; c < MAX_CROSSINGS; ++c)
      seen_points[c][k] = c < crossing_count ? stop_point(t[k], c) : vec2(0.0);
    if (has_dirt_at(POINT_FRONT, crossing_count)) seen_points[POINT_FRONT][k] = point_of_ray(t[k], POINT_FRONT);
  }
  seen_px = abs(0.5 * cross2(seen_pixels[1] - seen_pixels[0], seen_pixels[2] - seen_pixels[0]));
  seen_crossings = crossing_count;
}

// Points of the triangle at a crossing of the stop, or on the front.
struct SeenPlane {
  vec2 origin, u, v;
};
SeenPlane plane_at(uint c) {
  return SeenPlane(seen_points[c][0], seen_points[c][1] - seen_points[c][0], seen_points[c][2] - seen_points[c][0]);
}
vec2 point_in(SeenPlane plane, vec2 place) { return plane.origin + plane.u * place.x + plane.v * place.y; }
vec2 way_in(SeenPlane plane, vec2 way) { return plane.u * way.x + plane.v * way.y; }

// Places in the triangle are (u, v) from its first corner. This is the nearest to another one, in these coordinates.
vec2 nearest_in_triangle(vec2 place) {
  place = max(place, vec2(0.0));
  return place / max(place.x + place.y, 1.0);
}
vec2 place_of(vec2 pixel) {
  vec2 u = seen_pixels[1] - seen_pixels[0], v = seen_pixels[2] - seen_pixels[0], q = pixel - seen_pixels[0];
  float determinant = cross2(u, v);
  if (determinant == 0.0) return vec2(1.0 / 3.0);
  return nearest_in_triangle(vec2(cross2(q, v), cross2(u, q)) / determinant);
}

// The transmittance of the stop pattern about a place, as the mean over a pixel or, if that is smaller, the triangle.
float pattern_at(vec2 place) {
  float all = 1.0;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= seen_crossings) break;
    SeenPlane plane = plane_at(c);
    vec2 at = point_in(plane, place);
    float width = sqrt(0.5 * abs(cross2(plane.u, plane.v)) / max(seen_px, 1.0));
    all *= c + 1u == seen_crossings ? pattern_over_square(grid_pattern, at, width)
                                    : iris_over_square(at, width);
  }
  return all;
}

// The transmittance of a picture of dirt, or of dense dirt, likewise.
float dirt_at(vec2 place) {
  float all = 1.0, mm = dirt_float(DIRT_MM_A_UNIT);
  for (uint k = 0u; k < POINTS; ++k) {
    if (!has_dirt_at(k, seen_crossings)) continue;
    SeenPlane plane = plane_at(k);
    float width = sqrt(0.5 * abs(cross2(plane.u, plane.v)) / max(seen_px, 1.0));
    all *= dirt_over_square(point_in(plane, place) * mm, width * mm);
  }
  return all;
}

// The transmittance about a point in the triangle, in pixels.
float transmitted_at(uint dims, vec2 pixel) {
  vec2 place = place_of(pixel);
  float all = 1.0;
  if ((dims & DIMMED_BY_PATTERN) != 0u) all *= pattern_at(place);
  if ((dims & DIMMED_BY_DIRT) != 0u) all *= dirt_at(place);
  return all;
}
