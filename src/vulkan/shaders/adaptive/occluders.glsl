// SPDX-License-Identifier: Apache-2.0
// What dims a ghost's light besides rims and the sharp iris, as a mask: dirt where light crosses its plane, and the stop
// pattern at the last crossing of the stop. Points of a ray are numbered: where it crosses the stop, in stop radii, then
// where it crosses the front, in mm. Included after pattern.glsl.
#include "dirt.glsl"

#define POINT_FRONT 3u
#define POINTS 4u

// Bits of a mask: dirt at each point, the stop pattern.
#define OCCLUDED_BY_DIRT(k) (1u << (k))
#define OCCLUDED_BY_PATTERN 16u
#define LAST_SHIFT 28u  // of the last crossing's number, above the pattern's

bool has_dirt_at(uint k, uint crossing_count) {
  return k == POINT_FRONT ? (p.flags & FLAG_DIRT_ON_FRONT) != 0u
                          : k < crossing_count && (p.flags & FLAG_DIRT_IN_STOP) != 0u;
}

// Whether a mask needs a point.
bool needs_point(uint mask, uint k, uint last) {
  return (mask & OCCLUDED_BY_DIRT(k)) != 0u || k == last && (mask & OCCLUDED_BY_PATTERN) != 0u;
}

// The factor of what lies at a point, over a parallelogram whose sides are x and y.
float transmittance_of_point(uint mask, uint k, uint last, uint pattern, uint edge_bits, vec2 at, vec2 x, vec2 y) {
  float all = 1.0;
  if (k == last && (mask & OCCLUDED_BY_PATTERN) != 0u) all *= transmittance_at(pattern, at, x, y, edge_bits);
  if ((mask & OCCLUDED_BY_DIRT(k)) != 0u) {
    float mm = dirt_float(DIRT_MM_A_UNIT);
    all *= dirt_transmission(at * mm, x * mm, y * mm);
  }
  return all;
}

// Several strokes may lie beside each other in a pixel, so that the fractions that they leave, at one crossing of the stop
// or at several, do not multiply: the pixel is then seen in parts, whose products are averaged.
#define PARTS_OF_PIXEL 4  // a side

bool is_seen_in_parts() { return partly_covering > 1u; }
vec2 part_of_pixel(int k) { return (vec2(k % PARTS_OF_PIXEL, k / PARTS_OF_PIXEL) + 0.5) / float(PARTS_OF_PIXEL) - 0.5; }

// A disc about the points of a cell's corners, widened by a pixel's image: pixels at the cell's edge see beyond it.
struct Disc {
  vec2 middle;
  float radius;
};

#define DISC_OF_CELL 1.1  // points inside a cell lie a little farther out than those of its corners

Disc disc_of(vec2 a, vec2 b, vec2 c, float pixel_extent) {
  vec2 middle = (a + b + c) * (1.0 / 3.0);
  float radius = max(max(length(a - middle), length(b - middle)), length(c - middle));
  return Disc(middle, DISC_OF_CELL * radius + pixel_extent);
}

Disc disc_of(vec2 a, vec2 b, vec2 c, vec2 d, float pixel_extent) {
  vec2 middle = 0.25 * ((a + c) + (b + d));
  float radius = max(max(length(a - middle), length(c - middle)), max(length(b - middle), length(d - middle)));
  return Disc(middle, DISC_OF_CELL * radius + pixel_extent);
}

// Whether dirt may dim light within a disc about a point.
bool is_dirty(Disc disc) {
  float mm = dirt_float(DIRT_MM_A_UNIT);
  return !is_clean(disc.middle * mm, disc.radius * mm);
}
