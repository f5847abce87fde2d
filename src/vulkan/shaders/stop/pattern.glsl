// SPDX-License-Identifier: Apache-2.0
// Stop patterns, which take the place of the sharp iris at the last crossing of the stop:
// render/stop_patterns/stop_pattern.cpp, edge_profile.cpp and downsampled_picture.cpp. Patterns are numbered from 1 on;
// 0 is the sharp iris. Included after ../iris.glsl.
#include "pattern_record.glsl"
#define PROFILE_FIRST (-6.0)
#define PROFILE_LAST 32.0
#define PROFILE_STEPS 128.0  // a unit
#define PROFILE_POSITIONS 4865u
#define LEAST_WIDTH 1e-9

// The profile at a position, and its integral from the dark end less that of a sharp edge.
vec2 profile_between(uint table, float t) {
  float at = clamp((t - PROFILE_FIRST) * PROFILE_STEPS, 0.0, float(PROFILE_POSITIONS - 1u));
  uint k = min(uint(at), PROFILE_POSITIONS - 2u), word = table + 2u * k;
  vec2 low = vec2(uintBitsToFloat(patterns[word]), uintBitsToFloat(patterns[word + 1u]));
  vec2 high = vec2(uintBitsToFloat(patterns[word + 2u]), uintBitsToFloat(patterns[word + 3u]));
  return low + (high - low) * (at - float(k));
}

// The mean over a width about a position.
float profile_at(uint table, float t, float width) {
  float first = t - 0.5 * width, last = t + 0.5 * width;
  if (last <= PROFILE_FIRST) return 0.0;
  if (first >= PROFILE_LAST) return 1.0;
  if (width * PROFILE_STEPS < 1.0) return profile_between(table, t).x;
  float off_sharp = profile_between(table, last).y - profile_between(table, first).y;
  return (off_sharp + max(last, 0.0) - max(first, 0.0)) / width;
}

// The factor of an edge. The image of a pixel is a parallelogram, whose mean along the edge's normal is about that of a
// square of the same variance.
float edge_factor(uint pattern, float distance, float across) {
  float scale = pattern_scale(pattern);
  float t = -scale * distance, width = scale * across;
  if (t - 0.5 * width >= pattern_level_from(pattern)) return 1.0;
  return profile_at(pattern_table(pattern), t, width);
}

vec2 away_from(vec2 centre, vec2 at) {
  vec2 from = at - centre;
  return from / max(length(from), LEAST_WIDTH);
}

bool is_round_iris() { return (p.flags & FLAG_CIRCLE) != 0u; }

vec2 normal_at(uint b, vec2 at) { return is_straight(b) ? bound_normal(b) : away_from(bound_centre(b), at); }

// Edges as bits, if there are no more than 32.
#define ALL_EDGES 0xffffffffu
bool has_all_edges(uint edge_bits) { return edge_bits == ALL_EDGES || p.bound_count > 32u; }

// The mean of what the edges transmit of a parallelogram about a point. Where several edges count, their product is
// averaged over its quarters. The loop is over few edges, and none is within it: lavapipe ends loops after 65535 turns
// of all loops of an invocation.
float edges_at(uint pattern, vec2 at, vec2 x, vec2 y, uint edge_bits) {
  if (is_round_iris()) {
    vec2 normal = away_from(vec2(0.0), at);
    return max(edge_factor(pattern, length(at) - 1.0, length(vec2(dot(normal, x), dot(normal, y)))), 0.0);
  }
  bool every = has_all_edges(edge_bits);
  bool in_quarters = every || bitCount(edge_bits) > 1;
  vec4 product = vec4(1.0);
  uint left = edge_bits;
  for (uint k = 0u; every ? k < p.bound_count : left != 0u; ++k) {
    uint b = every ? k : uint(findLSB(left));
    left &= left - 1u;
    vec2 normal = normal_at(b, at);
    float distance = bound_distance(b, at), along_x = dot(normal, x), along_y = dot(normal, y);
    if (!in_quarters) {
      product.x *= edge_factor(pattern, distance, length(vec2(along_x, along_y)));
      continue;
    }
    float across = 0.5 * length(vec2(along_x, along_y));
    vec2 off = 0.25 * vec2(along_x + along_y, along_x - along_y);
    product *= vec4(edge_factor(pattern, distance - off.x, across), edge_factor(pattern, distance + off.x, across),
                    edge_factor(pattern, distance - off.y, across), edge_factor(pattern, distance + off.y, across));
  }
  return max(in_quarters ? 0.25 * (product.x + product.y + product.z + product.w) : product.x, 0.0);
}

float sample_of(uint first, int side, ivec2 at) {
  if (at.x < 0 || at.y < 0 || at.x >= side || at.y >= side) return 0.0;
  return uintBitsToFloat(patterns[first + uint(at.y * side + at.x)]);
}

float bilinear(uint first, int side, float extent, vec2 at) {
  vec2 place = vec2(at.x + extent, extent - at.y) * (0.5 * float(side) / extent) - 0.5;
  if (!(all(greaterThan(place, vec2(-1.0))) && all(lessThan(place, vec2(side))))) return 0.0;
  ivec2 low = ivec2(floor(place));
  vec2 part = place - vec2(low);
  return mix(mix(sample_of(first, side, low), sample_of(first, side, low + ivec2(1, 0)), part.x),
             mix(sample_of(first, side, low + ivec2(0, 1)), sample_of(first, side, low + ivec2(1, 1)), part.x), part.y);
}

float texture_at(uint pattern, vec2 at, float width) {
  int side = int(pattern_side(pattern));
  float extent = pattern_scale(pattern), samples = width * (0.57735027 * 0.5) * float(side) / extent;
  uint last = pattern_levels(pattern) - 1u, first = pattern_table(pattern);
  float level = clamp(log2(max(samples, 1.0)), 0.0, float(last));
  uint fine = min(uint(level), last);
  first += uint(4 * (side * side - (side >> fine) * (side >> fine)) / 3);  // the samples of finer levels
  side >>= fine;
  float value = bilinear(first, side, extent, at), rest = level - float(fine);
  if (rest <= 0.0 || fine == last) return value;
  return mix(value, bilinear(first + uint(side * side), side / 2, extent, at), rest);
}

#define FINE_SAMPLES 2.0  // of a texture in a parallelogram from which on its quarters are looked up

float texture_over(uint pattern, vec2 at, vec2 x, vec2 y) {
  float width = sqrt(abs(cross2(x, y)));
  if (max(length(x), length(y)) * float(pattern_side(pattern)) < 2.0 * FINE_SAMPLES * pattern_scale(pattern))
    return texture_at(pattern, at, width);
  vec2 a = 0.25 * (x + y), b = 0.25 * (x - y);
  return 0.25 * (texture_at(pattern, at - a, 0.5 * width) + texture_at(pattern, at + a, 0.5 * width) +
                 texture_at(pattern, at - b, 0.5 * width) + texture_at(pattern, at + b, 0.5 * width));
}

// The mean transmittance over a parallelogram of the stop about a point, whose sides are x and y. edge_bits: those of
// active_edges(), or ALL_EDGES.
float transmittance_at(uint pattern, vec2 at, vec2 x, vec2 y, uint edge_bits) {
  return pattern_side(pattern) == 0u ? edges_at(pattern, at, x, y, edge_bits) : texture_over(pattern, at, x, y);
}

// The edges that have fringes somewhere in a disc; 0: none.
uint active_edges(uint pattern, vec2 middle, float radius) {
  if (pattern_side(pattern) != 0u) return ALL_EDGES;
  float scale = pattern_scale(pattern), level_from = pattern_level_from(pattern);
  if (is_round_iris()) return scale * (1.0 - length(middle) - radius) < level_from ? 1u : 0u;
  uint edge_bits = 0u;
  for (uint b = 0u; b < p.bound_count; ++b)
    if (scale * (-bound_distance(b, middle) - radius) < level_from) edge_bits |= 1u << min(b, 31u);
  return edge_bits;
}

#define REGION_DARK 0
#define REGION_UNIFORM 1
#define REGION_VARYING 2
#define REGION_MARGIN 1.1  // the stop points inside a cell lie a little farther out than those of its corners

// The region of a cell, from where the rays of its corners cross the stop.
int region_of(uint pattern, vec2 a, vec2 b, vec2 c, vec2 d) {
  vec2 middle = 0.25 * ((a + c) + (b + d));
  float radius = max(max(length(a - middle), length(c - middle)), max(length(b - middle), length(d - middle)));
  radius *= REGION_MARGIN;
  if (pattern_side(pattern) != 0u)
    return length(middle) - radius > pattern_outer_radius(pattern) ? REGION_DARK : REGION_VARYING;
  float scale = pattern_scale(pattern), from_edge = iris_distance(middle);
  if (scale * (from_edge - radius) > -PROFILE_FIRST) return REGION_DARK;
  return scale * (-from_edge - radius) > pattern_level_from(pattern) ? REGION_UNIFORM : REGION_VARYING;
}
