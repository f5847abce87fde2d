// SPDX-License-Identifier: Apache-2.0
// Dirt with sharp shadows: render/planning/dirt_field.cpp and aperture/dirt_picture.cpp under the same names. Points
// are in mm of the dirt's plane; the part of the plane that a pixel sees is a parallelogram about a point, whose sides
// are x and y. Included after ../coverage.glsl.

// Words of the header, as written by dirt_words() (layout.cpp): numbers, and where tables begin.
#define DIRT_EXTENT 0u
#define DIRT_CELLS 1u
#define DIRT_MM_A_UNIT 2u
#define DIRT_EDGES_PER_MM 3u
#define DIRT_STROKES_AT 4u
#define DIRT_FIRST_AT 5u
#define DIRT_OF_CELL_AT 6u
#define DIRT_BLOCKED_AT 7u
#define DIRT_DIRTY_AT 8u
#define DIRT_PICTURE_AT 9u  // 0: none
#define DIRT_PICTURE_WIDTH 10u
#define DIRT_PICTURE_HEIGHT 11u
#define DIRT_CLEAR_RADIUS 12u
#define STROKE_WORDS 8u

#define DIRT_MOST_PARTS 8       // of a parallelogram, no longer than a cell each; more of them are averaged over cells
#define DIRT_MOST_SUBSAMPLES 4  // a side, where a picture is finer

float dirt_float(uint k) { return uintBitsToFloat(dirt[k]); }
float dirt_cell_mm() { return 2.0 * dirt_float(DIRT_EXTENT) / float(dirt[DIRT_CELLS]); }

struct Stroke {
  vec2 middle, along;
  float half_length, half_width, radius, opacity;
};

Stroke stroke_at(uint k) {
  uint at = dirt[DIRT_STROKES_AT] + STROKE_WORDS * k;
  return Stroke(vec2(dirt_float(at), dirt_float(at + 1u)), vec2(dirt_float(at + 2u), dirt_float(at + 3u)),
                dirt_float(at + 4u), dirt_float(at + 5u), dirt_float(at + 6u), dirt_float(at + 7u));
}

vec2 along_and_across(Stroke s, vec2 from_middle) {
  vec2 own = vec2(dot(s.along, from_middle), cross2(s.along, from_middle));
  if (s.radius == 0.0) return own;
  float size = abs(s.radius), side = sign(s.radius);
  vec2 from_centre = vec2(own.x, own.y - s.radius);
  float across = (2.0 * own.y * s.radius - dot(own, own)) / (size + length(from_centre));
  return vec2(atan(from_centre.x, -side * from_centre.y) * size, side * across);
}

float overlap(float at, float whole, float width) {
  return clamp(min(at + 0.5 * width, 0.5 * whole) - max(at - 0.5 * width, -0.5 * whole), 0.0, width) / width;
}

// The part of a parallelogram on the positive side of a straight edge, from the distance of its middle. slope: by its
// sides.
float part_inside(vec2 slope, float distance) {
  float reach = 0.5 * (abs(slope.x) + abs(slope.y));
  return abs(distance) >= reach ? (distance > 0.0 ? 1.0 : 0.0) : half_plane(slope, distance);
}

// The fraction of a parallelogram that a stroke covers: exact between straight sides. A round end larger than it is an
// edge; one that is smaller is the end of a rectangle of the stroke's width and area.
float covered_fraction(Stroke s, vec2 at, vec2 x, vec2 y) {
  vec2 from = at - s.middle;
  float reach = s.half_length + s.half_width + 0.5 * (length(x) + length(y));
  if (dot(from, from) > reach * reach) return 0.0;
  vec2 own = along_and_across(s, from);
  float turned = s.radius == 0.0 ? 0.0 : own.x / s.radius;
  vec2 turn = vec2(cos(turned), sin(turned));
  vec2 along = vec2(s.along.x * turn.x - s.along.y * turn.y, s.along.x * turn.y + s.along.y * turn.x);
  vec2 across = vec2(-along.y, along.x);
  float beyond = max(abs(own.x) - s.half_length, 0.0), squared_width = abs(cross2(x, y));
  bool is_narrow = squared_width < 4.0 * s.half_width * s.half_width;
  if (is_narrow && beyond > 0.0) {
    vec2 outwards = vec2(beyond * sign(own.x), own.y);
    float from_end = length(outwards);
    float inwards = s.half_width - sqrt(s.half_width * s.half_width - squared_width / 12.0);
    vec2 normal = (along * outwards.x + across * outwards.y) / from_end;
    return part_inside(vec2(dot(normal, x), dot(normal, y)), s.half_width - from_end - inwards);
  }
  vec2 slope = vec2(dot(across, x), dot(across, y));
  float between_sides = part_inside(slope, s.half_width - own.y) - part_inside(slope, -s.half_width - own.y);
  if (is_narrow || between_sides <= 0.0) return between_sides;
  float width_along = length(vec2(dot(along, x), dot(along, y)));
  return between_sides * overlap(own.x, 2.0 * s.half_length + 0.5 * 3.14159265 * s.half_width, width_along);
}

uint dirt_cell_of(float coordinate_mm) {
  float at = (coordinate_mm + dirt_float(DIRT_EXTENT)) / dirt_cell_mm();
  return uint(clamp(at, 0.0, float(dirt[DIRT_CELLS] - 1u)));
}

// The middle of a part of a parallelogram, from the parallelogram's middle.
vec2 part_of_parallelogram(int k, ivec2 parts, vec2 x, vec2 y) {
  vec2 at = (vec2(k % parts.x, k / parts.x) + 0.5) / vec2(parts) - 0.5;
  return at.x * x + at.y * y;
}

uint partly_covering = 0u;  // the number of strokes that were found to cover a part of a parallelogram

// A parallelogram no longer than a cell meets only strokes that are listed for the cell of its middle.
float small_transmission(vec2 at, vec2 x, vec2 y) {
  uint cell = dirt[DIRT_FIRST_AT] + dirt_cell_of(at.y) * dirt[DIRT_CELLS] + dirt_cell_of(at.x);
  float all = 1.0;
  for (uint k = dirt[cell], end = dirt[cell + 1u]; k < end; ++k) {
    Stroke s = stroke_at(dirt[dirt[DIRT_OF_CELL_AT] + k]);
    float covered = covered_fraction(s, at, x, y);
    if (covered > 0.0 && covered < 1.0) ++partly_covering;
    all *= 1.0 - s.opacity * covered;
  }
  return all;
}

uint dirt_corner(uvec2 corner) { return corner.y * (dirt[DIRT_CELLS] + 1u) + corner.x; }

// The light that all cells with lower coordinates than a point block, in cells.
float blocked_before(vec2 at) {
  float cells = float(dirt[DIRT_CELLS]);
  vec2 place = clamp((at + dirt_float(DIRT_EXTENT)) / dirt_cell_mm(), vec2(0.0), vec2(cells));
  uvec2 low = uvec2(min(place, vec2(cells - 1.0)));
  vec2 part = place - vec2(low);
  uint first = dirt[DIRT_BLOCKED_AT] + dirt_corner(low), next = first + dirt[DIRT_CELLS] + 1u;
  float below = mix(dirt_float(first), dirt_float(first + 1u), part.x);
  return mix(below, mix(dirt_float(next), dirt_float(next + 1u), part.x), part.y);
}

// The mean over a square, from those of whole cells.
float mean_of_cells(vec2 at, float width) {
  vec2 low = at - 0.5 * width, high = at + 0.5 * width;
  float blocked = (blocked_before(high) - blocked_before(vec2(low.x, high.y))) -
                  (blocked_before(vec2(high.x, low.y)) - blocked_before(low));
  float cells = width / dirt_cell_mm();
  return clamp(1.0 - blocked / (cells * cells), 0.0, 1.0);
}

float strokes_transmission(vec2 at, vec2 x, vec2 y) {
  float cell_mm = dirt_cell_mm();
  vec2 sides = vec2(length(x), length(y)) / cell_mm;
  if (max(sides.x, sides.y) <= 1.0) return small_transmission(at, x, y);
  if (!(max(sides.x, 1.0) * max(sides.y, 1.0) <= float(DIRT_MOST_PARTS)))
    return mean_of_cells(at, sqrt(abs(cross2(x, y))));
  ivec2 parts = ivec2(max(ceil(sides), vec2(1.0)));
  float sum = 0.0;
  for (int k = 0; k < parts.x * parts.y; ++k)
    sum += small_transmission(at + part_of_parallelogram(k, parts, x, y), x / float(parts.x), y / float(parts.y));
  return sum / float(parts.x * parts.y);
}

float dirt_level_at(ivec2 at) {
  ivec2 size = ivec2(dirt[DIRT_PICTURE_WIDTH], dirt[DIRT_PICTURE_HEIGHT]);
  if (at.x < 0 || at.y < 0 || at.x >= size.x || at.y >= size.y) return 1.0;
  return dirt_float(dirt[DIRT_PICTURE_AT] + uint(at.y * size.x + at.x));
}

// In pixels from the top left.
float between_pixels(vec2 place) {
  vec2 size = vec2(dirt[DIRT_PICTURE_WIDTH], dirt[DIRT_PICTURE_HEIGHT]);
  if (!(all(greaterThan(place, vec2(-1.0))) && all(lessThan(place, size)))) return 1.0;
  ivec2 low = ivec2(floor(place));
  vec2 part = place - vec2(low);
  return mix(mix(dirt_level_at(low), dirt_level_at(low + ivec2(1, 0)), part.x),
             mix(dirt_level_at(low + ivec2(0, 1)), dirt_level_at(low + ivec2(1, 1)), part.x), part.y);
}

float picture_transmission(vec2 at, vec2 x, vec2 y) {
  vec2 size = vec2(dirt[DIRT_PICTURE_WIDTH], dirt[DIRT_PICTURE_HEIGHT]);
  vec2 scale = vec2(0.5, -0.5) * max(size.x, size.y) / dirt_float(DIRT_CLEAR_RADIUS);  // pixels a mm
  vec2 place = at * scale + 0.5 * size - 0.5, across = x * scale, down = y * scale;
  ivec2 parts = ivec2(clamp(ceil(vec2(length(across), length(down))), vec2(1.0), vec2(DIRT_MOST_SUBSAMPLES)));
  float sum = 0.0;
  for (int k = 0; k < parts.x * parts.y; ++k)
    sum += between_pixels(place + part_of_parallelogram(k, parts, across, down));
  return sum / float(parts.x * parts.y);
}

// The mean transmittance of the dirt over a parallelogram.
float dirt_transmission(vec2 at, vec2 x, vec2 y) {
  float all = strokes_transmission(at, x, y);
  return dirt[DIRT_PICTURE_AT] == 0u ? all : all * picture_transmission(at, x, y);
}

// Whether no stroke comes near a disc: true only where dirt_transmission() is 1.
bool is_clean(vec2 middle, float radius) {
  if (dirt[DIRT_PICTURE_AT] != 0u) return false;
  uvec2 low = uvec2(dirt_cell_of(middle.x - radius), dirt_cell_of(middle.y - radius));
  uvec2 high = uvec2(dirt_cell_of(middle.x + radius), dirt_cell_of(middle.y + radius)) + 1u;
  uint at = dirt[DIRT_DIRTY_AT];
  return dirt[at + dirt_corner(high)] + dirt[at + dirt_corner(low)] ==
         dirt[at + dirt_corner(uvec2(low.x, high.y))] + dirt[at + dirt_corner(uvec2(high.x, low.y))];
}
