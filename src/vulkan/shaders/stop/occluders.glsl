// SPDX-License-Identifier: Apache-2.0
// A mask lists what dims a ghost's light besides rims and the sharp iris: dirt where light crosses its plane, the stop
// pattern at the last crossing of the stop, and a picture as the iris at each crossing. Points of a ray are numbered:
// where it crosses the stop, in stop radii, then where it crosses the front, in mm. Included after pattern.glsl.
#include "dirt.glsl"
#include "tones.glsl"

#define POINT_FRONT 3u
#define POINTS 4u

// Bits of a mask: dirt at each point, the stop pattern, a picture as the iris at each crossing.
#define OCCLUDED_BY_DIRT(k) (1u << (k))
#define OCCLUDED_BY_PATTERN 16u
#define OCCLUDED_BY_PICTURE(k) (32u << (k))
#define LAST_SHIFT 28u  // of the last crossing's number, above the pattern's

bool has_dirt_at(uint k, uint crossing_count) {
  return k == POINT_FRONT ? (p.flags & FLAG_DIRT_ON_FRONT) != 0u
                          : k < crossing_count && (p.flags & FLAG_DIRT_IN_STOP) != 0u;
}

// Whether a mask needs a point.
bool needs_point(uint mask, uint k, uint last) {
  return (mask & (OCCLUDED_BY_DIRT(k) | OCCLUDED_BY_PICTURE(k))) != 0u ||
         k == last && (mask & OCCLUDED_BY_PATTERN) != 0u;
}

float picture_distance(vec2 at) {
  if (length(at) > PICTURE_RADIUS) return length(at) - 1.0;
  return bilinear(pattern_table(p.picture + 1u), int(pattern_side(p.picture)), pattern_scale(p.picture), at);
}

#define COARSE_SAMPLES 4.0  // of a picture across a parallelogram, from which on the outline is not an edge in it

// The mean transmittance of a picture as the iris over a parallelogram.
float picture_over(vec2 at, vec2 x, vec2 y) {
  float sample_width = 2.0 * pattern_scale(p.picture) / float(pattern_side(p.picture));
  if (max(length(x), length(y)) > COARSE_SAMPLES * sample_width) return texture_over(p.picture, at, x, y);
  float distance = picture_distance(at), reach = 0.5 * (length(x) + length(y));
  if (distance >= reach) return 0.0;
  float open = 1.0;
  if (distance > -reach) {
    vec2 right = vec2(sample_width, 0.0), up = right.yx;
    vec2 outwards = vec2(picture_distance(at + right) - picture_distance(at - right),
                         picture_distance(at + up) - picture_distance(at - up));
    vec2 normal = outwards / max(length(outwards), LEAST_WIDTH);
    open = part_inside(vec2(dot(normal, x), dot(normal, y)), -distance);
    if (open > 0.0 && open < 1.0) ++partly_covering;
  }
  return open > 0.0 ? open * tone_over_square(at, sqrt(abs(cross2(x, y)))) : 0.0;
}

// The factor of what lies at a point, over a parallelogram whose sides are x and y.
float transmittance_of_point(uint mask, uint k, uint last, uint pattern, uint edge_bits, vec2 at, vec2 x, vec2 y) {
  float all = 1.0;
  if (k == last && (mask & OCCLUDED_BY_PATTERN) != 0u) all *= transmittance_at(pattern, at, x, y, edge_bits);
  if (HAS_PICTURE && (mask & OCCLUDED_BY_PICTURE(k)) != 0u) all *= picture_over(at, x, y);
  if ((mask & OCCLUDED_BY_DIRT(k)) != 0u) {
    float mm = dirt_float(DIRT_MM_A_UNIT);
    all *= dirt_transmission(at * mm, x * mm, y * mm);
  }
  return all;
}

// Several strokes or outlines may lie beside each other in a pixel, so that the fractions that they leave, at one
// crossing of the stop or at several, do not multiply: the pixel is then seen in parts, whose products are averaged.
#define PARTS_OF_PIXEL 4  // a side

bool is_seen_in_parts() { return partly_covering > 1u; }

// The whole pixel comes before its parts, in one loop: drivers compile what the loop calls at each place where it is
// called, and it is long.
#define WHOLE_PIXEL (-1)
vec2 part_of_pixel(int k) {
  if (k == WHOLE_PIXEL) return vec2(0.0);
  return (vec2(k % PARTS_OF_PIXEL, k / PARTS_OF_PIXEL) + 0.5) / float(PARTS_OF_PIXEL) - 0.5;
}
float width_of_part(int k) { return k == WHOLE_PIXEL ? 1.0 : 1.0 / float(PARTS_OF_PIXEL); }

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

// Says whether a picture as the iris is dark, uniform or varying over a disc of the stop.
int region_of_picture(Disc disc) {
  float distance = picture_distance(disc.middle);
  if (distance > disc.radius) return REGION_DARK;
  return -distance > disc.radius && !has_half_tones() ? REGION_UNIFORM : REGION_VARYING;
}
