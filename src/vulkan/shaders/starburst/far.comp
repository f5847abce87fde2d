// SPDX-License-Identifier: Apache-2.0
// Adds the starbursts of all lights to a pixel, from the rings' means over pixels: one pixel an invocation, the lights
// in their order. Pixels near a light's image are near.comp's.
// The functions are those of src/diffraction/ring_reader.cpp, sharp_zone.cpp and pixel_profile.h.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "rings.glsl"

#define LN2 0.693147181

// The words of an octave of rings.
struct Octave {
  uint bins, rgb0_at;
  uint zone_of_bin_at, zones_at;  // zone_of_bin_at: 0 if there are no zones
};

Octave octave_at(uint word) {
  return Octave(starbursts[word], starbursts[word + 1u], starbursts[word + 2u], starbursts[word + 3u]);
}

// Interpolates means over pixels between the rows and the bins' edges on both sides.
vec3 read_means(Octave octave, uint bin, float row, float turns) {
  uint above = min(uint(row), uint(ROWS_PER_OCTAVE - 1));
  float t = min(row - float(above), 1.0), s = min(turns * float(octave.bins) - float(bin), 1.0);
  uint first = octave.rgb0_at + 3u * (above * (octave.bins + 1u) + bin), second = first + 3u * (octave.bins + 1u);
  vec3 upper = mix(rgb_at(first), rgb_at(first + 3u), s), lower = mix(rgb_at(second), rgb_at(second + 3u), s);
  return mix(upper, lower, t);
}

// PixelProfile, for pixels of width 1.
struct Profile {
  float level, extent, per_wide, per_slope;
};

Profile profile_of(vec2 along) {
  float wide = max(abs(along.x), abs(along.y)), narrow = min(abs(along.x), abs(along.y));
  return Profile(0.5 * (wide - narrow), 0.5 * (wide + narrow), 1.0 / wide,
                 narrow > 1e-6 * wide ? 0.5 / (wide * narrow) : 0.0);
}

// The fraction of the pixel below a line at this signed distance.
float fraction_below(Profile profile, float distance_px) {
  float d = min(abs(distance_px), profile.extent), beyond = d - profile.level;
  float left = profile.extent - d;
  float part = beyond > 0.0 ? 0.5 - left * left * profile.per_slope : d * profile.per_wide;
  return distance_px < 0.0 ? 0.5 - part : 0.5 + part;
}

// The middle of a pixel's chord along a direction at a distance from the pixel's middle, measured along the chord from
// the foot of the perpendicular.
float chord_middle(vec2 along, float distance_px) {
  const float across = 1e-3;  // cosines below it count as parallel to a pair of sides
  if (abs(along.x) < across || abs(along.y) < across) return 0.0;
  vec2 offset = vec2(-along.y, along.x) * distance_px;
  vec2 a = (0.5 - offset) / along, b = (-0.5 - offset) / along;
  vec2 from = min(a, b), to = max(a, b);
  return 0.5 * (max(from.x, from.y) + min(to.x, to.y));
}

// The number of a zone's edges that are not beyond a position.
uint edges_up_to(uint edge_at, uint count, float position) {
  uint low = 0u, high = count;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (float_at(edge_at + middle) <= position)
      low = middle + 1u;
    else
      high = middle;
  }
  return low;
}

// The cells' densities weighted by the lengths of the pixel's chords.
vec3 read_zone(uint zone_at, uint bins, float row, float turns, vec2 at) {
  uint first_bin = starbursts[zone_at], cells = starbursts[zone_at + 1u];
  uint edge_at = starbursts[zone_at + 2u], rgb0_at = starbursts[zone_at + 3u];
  float whole = float(bins), position = turns * whole - float(first_bin);
  if (position < 0.0) position += whole;
  float r = length(at);
  vec2 along = at / r;
  float px_per_bin = r * PI / whole, rows_per_px = float(ROWS_PER_OCTAVE) / (LN2 * r);
  Profile profile = profile_of(along);
  uint cell = max(edges_up_to(edge_at, cells + 1u, position - profile.extent / px_per_bin), 1u) - 1u;
  float fraction_before = 0.0, from = -profile.extent;
  vec3 sum = vec3(0.0);
  for (; cell < cells && fraction_before < 1.0; ++cell) {
    float to = (float_at(edge_at + cell + 1u) - position) * px_per_bin;
    float fraction = to < profile.extent ? fraction_below(profile, to) : 1.0;
    float middle = chord_middle(along, 0.5 * (from + min(to, profile.extent)));
    float read_row = clamp(row + rows_per_px * middle, 0.0, float(ROWS_PER_OCTAVE));
    uint above = min(uint(read_row), uint(ROWS_PER_OCTAVE - 1));
    uint first = rgb0_at + 3u * (above * cells + cell);
    sum += (fraction - fraction_before) * mix(rgb_at(first), rgb_at(first + 3u * cells), read_row - float(above));
    fraction_before = fraction;
    from = to;
  }
  return sum;
}

// The density at a position that is not near. The octave is the exponent of the squared radius, so that the logarithm
// is taken of 1 to 4 only.
vec3 read_rings(uint pattern, vec2 at) {
  float squared = max(dot(at, at) * float_at(pattern), 1.0);
  uint bits = floatBitsToUint(squared), octave_number = ((bits >> 23u) - 127u) / 2u;
  if (octave_number >= starbursts[pattern + 1u]) return vec3(0.0);
  float row = clamp(0.5 * float(ROWS_PER_OCTAVE) * log2(uintBitsToFloat(bits - (octave_number << 24u))), 0.0,
                    float(ROWS_PER_OCTAVE));
  float slope = slope_turns(at);
  float turns = clamp((at.x < 0.0) == (at.y < 0.0) ? 0.5 + slope : 0.5 - slope, 0.0, 1.0);
  Octave octave = octave_at(starbursts[pattern + 2u] + FAR_WORDS * octave_number);
  uint bin = min(uint(turns * float(octave.bins)), octave.bins - 1u);
  uint zone = octave.zone_of_bin_at == 0u ? 0u : starbursts[octave.zone_of_bin_at + bin];
  if (zone == 0u) return read_means(octave, bin, row, turns);
  return read_zone(octave.zones_at + ZONE_WORDS * (zone - 1u), octave.bins, row, turns, at);
}

void main() {
  uint k = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
  if (k >= uint(p.width) * uint(p.height)) return;
  ivec2 pixel = ivec2(k % uint(p.width), k / uint(p.width));
  vec3 sum = vec3(0.0);
  for (uint light = 0u; light < p.light_count; ++light) {
    vec2 at = from_image(light, pixel);
    if (!is_near(at)) sum += flux_of(light) * read_rings(pattern_of(light), at);
  }
  for (uint c = 0u; c < 3u; ++c) picture[3u * k + c] += sum[c];
}
