// SPDX-License-Identifier: Apache-2.0
// The half-tones of a picture as the iris: aperture/half_tones.cpp. Points in stop radii. Included after pattern.glsl.

// The first word after a table's coordinates of the stop's x axis in the picture, and a point in the picture.
uint after_axis(uint table) { return table + 2u; }
vec2 picture_from_stop(uint table, vec2 at) {
  vec2 axis = vec2(uintBitsToFloat(patterns[table]), uintBitsToFloat(patterns[table + 1u]));
  return vec2(axis.x * at.x - axis.y * at.y, axis.y * at.x + axis.x * at.y);
}

bool has_half_tones() { return HAS_PICTURE && (p.flags & FLAG_HALF_TONES) != 0u; }

// The half-tone of a picture as the iris; otherwise 1. The square is upright in the picture,
// and points beyond it do not count. Of a square of more than MOST_TONES samples a side, a coarser level is summed.
#define MOST_TONES 6.0

// The sum of samples over a box in samples of a level, which are constant within each.
float sum_of_tones(uint first, int side, vec2 low, vec2 high) {
  ivec2 from = ivec2(low), to = min(ivec2(ceil(high)), ivec2(side));
  float sum = 0.0;
  for (ivec2 at = from; at.y < to.y; at = at.x + 1 < to.x ? ivec2(at.x + 1, at.y) : ivec2(from.x, at.y + 1)) {
    vec2 part = min(high, vec2(at + 1)) - max(low, vec2(at));
    sum += part.x * part.y * uintBitsToFloat(patterns[first + uint(at.y * side + at.x)]);
  }
  return sum;
}

float tone_over_square(vec2 at, float width) {
  if (!has_half_tones()) return 1.0;
  uint tones = p.picture + 3u, table = pattern_table(tones), first = after_axis(table);
  int side = int(pattern_side(tones));
  float samples = pattern_scale(tones), scale = 0.5 * samples;
  vec2 middle = (picture_from_stop(table, at) + 1.0) * scale;
  float half_width = 0.5 * max(width * scale, 1.0);
  vec2 low = clamp(middle - half_width, vec2(0.0), vec2(samples));
  vec2 high = clamp(middle + half_width, vec2(0.0), vec2(samples));
  float area = (high.x - low.x) * (high.y - low.y), pitch = 1.0;
  if (!(area > 0.0)) return 0.0;
  for (uint level = 1u; level < pattern_levels(tones) && 2.0 * half_width > MOST_TONES * pitch; ++level) {
    first += uint(side * side);
    side /= 2;
    pitch *= 2.0;
  }
  return clamp(sum_of_tones(first, side, low / pitch, high / pitch) * pitch * pitch / area, 0.0, 1.0);
}
