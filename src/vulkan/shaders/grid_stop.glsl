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
#define CLIPPED_BY_PICTURE 4u  // as the iris, with a sharp outline
#define DIMMED_TO_NOTHING 8u

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

// The disc about the points of a cell's corners.
Disc disc_about(vec2 q[4]) {
  vec2 middle = 0.25 * (q[0] + q[1] + q[2] + q[3]);
  float radius = 0.0;
  for (int k = 0; k < 4; ++k) radius = max(radius, length(q[k] - middle));
  return Disc(middle, DISC_OF_CORNERS * radius);
}

// What dims the cell of four rays in order. If a ray has failed, patterns count as varying, and the cell as dirty.
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
      int region = any_failed ? REGION_VARYING : region_of_picture(disc);
      if (region == REGION_DARK) return DIMMED_TO_NOTHING;
      if (region == REGION_VARYING) dims |= CLIPPED_BY_PICTURE;
    }
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

// Points of the triangle at a crossing of the stop.
struct SeenPlane {
  vec2 origin, u, v;
};
SeenPlane plane_at(uint c) {
  return SeenPlane(seen_stops[c][0], seen_stops[c][1] - seen_stops[c][0], seen_stops[c][2] - seen_stops[c][0]);
}
vec2 point_in(SeenPlane plane, vec2 place) { return plane.origin + plane.u * place.x + plane.v * place.y; }
vec2 way_in(SeenPlane plane, vec2 way) { return plane.u * way.x + plane.v * way.y; }

// Places in the triangle are (u, v) from its first corner. This map turns a way in pixels into one of these. A thin
// triangle counts as thicker, so that pixels beside it do not see far beyond it.
mat2 from_pixels() {
  vec2 a = seen_pixels[1] - seen_pixels[0], b = seen_pixels[2] - seen_pixels[0];
  float longest = max(max(length(a), length(b)), length(a - b)), thickness = 2.0 * seen_px / longest;
  float least = min(0.1 * longest, 1.0), extra = thickness < least ? least * least - thickness * thickness : 0.0;
  float aa = dot(a, a) + extra, bb = dot(b, b) + extra, ab = dot(a, b), scale = 1.0 / (aa * bb - ab * ab);
  return transpose(mat2((a * bb - b * ab) * scale, (b * aa - a * ab) * scale));
}

// The place in the triangle that is nearest to another one, in these coordinates.
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

// What the stop pattern transmits about a place, as the mean over a pixel or, if that is smaller, the triangle.
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

// What shapes with sharp edges leave of a parallelogram about a place, whose sides are ways in the triangle.
float shapes_at(uint dims, vec2 place, vec2 across, vec2 down) {
  float all = 1.0;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= seen_crossings) break;
    SeenPlane plane = plane_at(c);
    vec2 at = point_in(plane, place), x = way_in(plane, across), y = way_in(plane, down);
    if ((dims & DIMMED_BY_DIRT) != 0u) {
      float mm = dirt_float(DIRT_MM_A_UNIT);
      all *= dirt_transmission(at * mm, x * mm, y * mm);
    }
  }
  return all;
}

// Says whether shapes leave all of a parallelogram, or a part.
int region_of_shapes(uint dims, vec2 place, vec2 across, vec2 down) {
  int all = REGION_UNIFORM;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= seen_crossings) break;
    SeenPlane plane = plane_at(c);
    Disc disc = Disc(point_in(plane, place), 0.5 * (length(way_in(plane, across)) + length(way_in(plane, down))));
    if ((dims & DIMMED_BY_DIRT) != 0u && is_dirty(disc)) all = REGION_VARYING;
  }
  return all;
}

#define SEEN_PARTS 4      // of a pixel or of a triangle, a side
#define SMALL_SEEN 0.05   // pixels of a triangle that has the mean over itself in all pixels

// What shapes leave of a pixel, from its middle. All larger triangles in a pixel have its mean, as seen through their
// own maps: a mean over the part of it that each covers would need as many parts for each.
float shapes_in_pixel(uint dims, vec2 middle) {
  mat2 to_place = from_pixels();
  vec2 from = middle - (seen_pixels[0] + seen_pixels[1] + seen_pixels[2]) * (1.0 / 3.0), middle_place = vec2(1.0 / 3.0);
  const float size = 1.0 / float(SEEN_PARTS);
  int region = region_of_shapes(dims, middle_place + to_place * from, to_place[0], to_place[1]);
  if (region == REGION_UNIFORM) return 1.0;
  float sum = 0.0;
  for (int k = 0; k < SEEN_PARTS * SEEN_PARTS; ++k) {
    vec2 part = from + (vec2(k % SEEN_PARTS, k / SEEN_PARTS) + 0.5) * size - 0.5;
    sum += shapes_at(dims, middle_place + to_place * part, size * to_place[0], size * to_place[1]);
  }
  return sum / float(SEEN_PARTS * SEEN_PARTS);
}

// What they leave of the whole triangle.
float shapes_in_triangle(uint dims) {
  const float size = 1.0 / float(SEEN_PARTS);
  float sum = 0.0;
  for (int k = 0; k < SEEN_PARTS * SEEN_PARTS; ++k) {
    ivec2 at = ivec2(k % SEEN_PARTS, k / SEEN_PARTS);
    bool is_upper = at.x + at.y >= SEEN_PARTS;  // half of the parallelogram's parts have their mirror image here
    vec2 place = (vec2(is_upper ? SEEN_PARTS - 1 - at : at) + (is_upper ? 2.0 / 3.0 : 1.0 / 3.0)) * size;
    sum += shapes_at(dims, place, 0.70710678 * size * vec2(1.0, 0.0), 0.70710678 * size * vec2(0.0, 1.0));
  }
  return sum / float(SEEN_PARTS * SEEN_PARTS);
}

// What is transmitted in a pixel of the triangle, from its middle.
float transmitted_in_pixel(uint dims, vec2 middle) {
  float all = 1.0;
  if ((dims & DIMMED_BY_PATTERN) != 0u) all = pattern_at(place_of(middle));
  if ((dims & DIMMED_BY_DIRT) == 0u) return all;
  return all * (seen_px < SMALL_SEEN ? shapes_in_triangle(dims) : shapes_in_pixel(dims, middle));
}

// What is transmitted of a polygon that is drawn as a point or a line, about its middle. pixel: the middle of its pixel.
float transmitted_of_point(uint dims, vec2 middle, vec2 pixel, bool is_line) {
  float all = 1.0;
  if ((dims & DIMMED_BY_PATTERN) != 0u) all = pattern_at(place_of(middle));
  if ((dims & DIMMED_BY_DIRT) == 0u) return all;
  return all * (is_line || seen_px < SMALL_SEEN ? shapes_in_triangle(dims) : shapes_in_pixel(dims, pixel));
}
