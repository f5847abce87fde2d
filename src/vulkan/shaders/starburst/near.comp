// SPDX-License-Identifier: Apache-2.0
// Adds the middle of a light's starburst. Each cell of the rings is integrated exactly along rays from the light's
// image; the invocations of a pixel share the cells that it meets: few, except about the image's own pixel, where one
// dispatch has 64 invocations a pixel, while another one has 4 for all other pixels.
// The functions are those of src/diffraction/near_field.cpp.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "rings.glsl"

#define BETWEEN_RAYS_PX 0.1  // kBetweenRays_px
#define ROW_WORDS 6u         // RGB each of the flux per radian from the octave's first row to this one, and of this one
#define CENTRAL_PIXELS 4     // kCentralPixels

// Corners from the light's image, y up.
struct Square {
  vec2 low, high;
};

// The words of an octave of cells. rows_at: by cell and row, ROW_WORDS.
struct NearOctave {
  float first_px, end_px, first_row_px;
  uint cells, edge_at, along_at, row_edge2_at, rows_at;
};

NearOctave near_octave_at(uint word) {
  return NearOctave(float_at(word), float_at(word + 1u), float_at(word + 2u), starbursts[word + 3u],
                    starbursts[word + 4u], starbursts[word + 5u], starbursts[word + 6u], starbursts[word + 7u]);
}

shared vec3 sums_of[64];

// The direction in half turns from straight down, -1/2 to 3/2.
float turns_of(vec2 at) {
  float turns = slope_turns(at);
  if (at.x < 0.0) turns = 1.0 - turns;
  return 0.5 + (at.y < 0.0 ? -turns : turns);
}

// The directions of a square's corners in half turns, rising, and where the last part ends: after a full turn if the
// light's image lies within the square, else at the last corner.
struct Arc {
  vec4 corners;
  float end;
};

void sort(inout float a, inout float b) {
  float low = min(a, b);
  b = max(a, b);
  a = low;
}

Arc arc_of(Square s) {
  vec4 turns = vec4(turns_of(s.low), turns_of(vec2(s.high.x, s.low.y)), turns_of(s.high),
                    turns_of(vec2(s.low.x, s.high.y)));
  if (s.low.x < 0.0 && s.low.y < 0.0 && s.high.x > 0.0 && s.high.y > 0.0) {
    vec4 from_first = turns - turns.x;
    return Arc(turns.x + from_first - 2.0 * floor(0.5 * from_first), turns.x + 2.0);  // the corners rise as they are
  }
  turns += 2.0 * round(0.5 * (turns_of(0.5 * (s.low + s.high)) - turns));
  sort(turns.x, turns.y);
  sort(turns.z, turns.w);
  sort(turns.x, turns.z);
  sort(turns.y, turns.w);
  sort(turns.y, turns.z);
  return Arc(turns, turns.w);
}

// The directions between which a part of the arc lies, 0 to 3.
vec2 part_of(Arc arc, uint n) {
  return n == 0u ? arc.corners.xy : n == 1u ? arc.corners.yz : n == 2u ? arc.corners.zw : vec2(arc.corners.w, arc.end);
}

float nearest_px(Square s) { return length(max(max(s.low, -s.high), vec2(0.0))); }
float farthest_px(Square s) { return length(max(abs(s.low), abs(s.high))); }

void between(float low, float high, float slope, inout vec2 chord) {
  if (slope == 0.0) {
    if (low > 0.0 || high < 0.0) chord.y = -1.0;
    return;
  }
  float a = low / slope, b = high / slope;
  chord = vec2(max(chord.x, min(a, b)), min(chord.y, max(a, b)));
}

// The radii between which a ray from the light's image lies within a square; the second is smaller if it misses it.
vec2 chord_of(Square square, vec2 along) {
  vec2 chord = vec2(0.0, 1e30);
  between(square.low.x, square.high.x, along.x, chord);
  between(square.low.y, square.high.y, along.y, chord);
  return chord;
}

// The row at a radius, and the part of its area within the radius.
float part_of_row(NearOctave octave, float radius_px, out uint row) {
  float position =
      radius_px > octave.first_row_px ? float(ROWS_PER_OCTAVE) * log2(radius_px / octave.first_row_px) : 0.0;
  row = min(uint(position), uint(ROWS_PER_OCTAVE - 1));
  float inner = float_at(octave.row_edge2_at + row), outer = float_at(octave.row_edge2_at + row + 1u);
  return (radius_px * radius_px - inner) / (outer - inner);
}

// The flux per radian between two radii in a cell.
vec3 flux_of_ray(NearOctave octave, uint cell, float from_px, float to_px) {
  uint from_row, to_row;
  float from_part = part_of_row(octave, from_px, from_row), to_part = part_of_row(octave, to_px, to_row);
  uint rows = octave.rows_at + ROW_WORDS * cell * uint(ROWS_PER_OCTAVE + 1);
  uint from = rows + ROW_WORDS * from_row, to = rows + ROW_WORDS * to_row;
  return rgb_at(to) - rgb_at(from) + to_part * rgb_at(to + 3u) - from_part * rgb_at(from + 3u);
}

vec2 along_at(NearOctave octave, uint k) {
  return vec2(float_at(octave.along_at + 2u * k), float_at(octave.along_at + 2u * k + 1u));
}

// The flux between two directions within a cell, in half turns from the beginning of the cell's half turn. turned: -1
// for the directions half a turn on, else 1.
vec3 flux_of_sector(NearOctave octave, uint cell, vec2 turns, float turned, Square square) {
  float cell_from = float_at(octave.edge_at + cell), width = float_at(octave.edge_at + cell + 1u) - cell_from;
  int rays = 1 + int((turns.y - turns.x) * PI * octave.end_px / BETWEEN_RAYS_PX);
  float turns_a_ray = (turns.y - turns.x) / float(rays);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < rays; ++k) {
    float t = (turns.x + (float(k) + 0.5) * turns_a_ray - cell_from) / width;
    vec2 chord = chord_of(square, mix(along_at(octave, cell), along_at(octave, cell + 1u), t) * turned);
    float near = max(chord.x, octave.first_px), far = min(chord.y, octave.end_px);
    if (far > near) sum += turns_a_ray * PI * flux_of_ray(octave, cell, near, far);
  }
  return sum;
}

// The number of a direction's cell, counted from the cell straight down of half turn 0 on.
int cell_of(NearOctave octave, float turn) {
  float half_turns = floor(turn);
  uint low = 0u, high = octave.cells;  // edge[low] <= turn - half_turns < edge[high], which is 1
  while (low + 1u < high) {
    uint middle = (low + high) / 2u;
    if (float_at(octave.edge_at + middle) <= turn - half_turns)
      low = middle;
    else
      high = middle;
  }
  return int(half_turns) * int(octave.cells) + int(low);
}

// An invocation's part of the flux of an octave's cells.
vec3 flux_of_arc(NearOctave octave, Arc arc, Square square) {
  int cells = int(octave.cells), last = cell_of(octave, arc.end);
  vec3 sum = vec3(0.0);
  for (int k = cell_of(octave, arc.corners.x) + int(gl_LocalInvocationID.x % p.sharing); k <= last;
       k += int(p.sharing)) {
    int half_turn = int(floor((float(k) + 0.5) / float(cells)));
    uint cell = uint(k - half_turn * cells);
    float begin = float(half_turn), turned = (half_turn & 1) == 0 ? 1.0 : -1.0;
    float from = begin + float_at(octave.edge_at + cell), to = begin + float_at(octave.edge_at + cell + 1u);
    for (uint n = 0u; n < 4u; ++n) {
      vec2 part = part_of(arc, n);
      part = vec2(max(from, part.x), min(to, part.y));
      if (part.y > part.x) sum += flux_of_sector(octave, cell, part - begin, turned, square);
    }
  }
  return sum;
}

// The flux over a square; points beyond the octaves count as dark.
vec3 flux_over(uint pattern, Square square) {
  float nearest = nearest_px(square), farthest = farthest_px(square);
  Arc arc = arc_of(square);
  vec3 sum = vec3(0.0);
  uint octaves = starbursts[pattern + 3u], octaves_at = starbursts[pattern + 4u];
  for (uint o = 0u; o < octaves; ++o) {
    uint word = octaves_at + NEAR_WORDS * o;
    if (float_at(word) < farthest && float_at(word + 1u) > nearest)
      sum += flux_of_arc(near_octave_at(word), arc, square);
  }
  return sum;
}

void main() {
  uint k = gl_LocalInvocationID.x;
  ivec2 pixel = ivec2(p.left, p.top) + ivec2(gl_WorkGroupID.x * (64u / p.sharing) + k / p.sharing, gl_WorkGroupID.y);
  vec2 middle = from_image(p.light, pixel);
  bool is_central = all(lessThanEqual(abs(whole_pixels(p.light, pixel)), ivec2(CENTRAL_PIXELS)));
  bool is_drawn = pixel.x < p.width && is_near(middle) && is_central == (p.sharing == 64u);
  sums_of[k] = is_drawn ? flux_over(pattern_of(p.light), Square(middle - 0.5, middle + 0.5)) : vec3(0.0);
  barrier();
  if (!is_drawn || k % p.sharing != 0u) return;
  vec3 sum = vec3(0.0);
  for (uint other = 0u; other < p.sharing; ++other) sum += sums_of[k + other];
  vec3 light = flux_of(p.light) * sum;
  uint at = 3u * (uint(pixel.y) * uint(p.width) + uint(pixel.x));
  for (uint c = 0u; c < 3u; ++c) picture[at + c] += light[c];
}
