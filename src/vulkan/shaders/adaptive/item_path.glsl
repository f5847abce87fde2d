// SPDX-License-Identifier: Apache-2.0
// The path of an item, for ../trace.glsl.
#include "../start.glsl"
#include "item_start.glsl"

uint path_item;

float start_real(int k) { return start_real_of(path_item, k); }
float path_number(uint k) { return texelFetch(float_texels, int(k >> 2u))[k & 3u]; }
vec2 table_pair(int k) { return texelFetch(table_texels, k).xy; }

// Items of a dispatch have different paths, whose numbers are therefore texels rather than uniforms. A path begins at a
// whole texel, and a step at a sphere is one texel of each kind.
uint first_step_texel, first_word_texel;
vec4 step_quarter(uint step, int k) { return texelFetch(float_texels, int(first_step_texel + 5u * step) + k); }
ivec4 step_words(uint step, int k) { return texelFetch(integer_texels, int(first_word_texel + 2u * step) + k); }
#define PATH_QUARTERS

#include "../trace.glsl"

void set_path(uint item) {
  path_item = item;
  path_reals = item_word(item, 0u);
  first_step_texel = (path_reals + PATH_REALS) / 4u;
  first_word_texel = item_word(item, 1u) / 4u;
  path_steps = item_word(item, 2u);
}

// Two rays along the same path, as one: a ray waits for its roots and divisions most of the time, and for the numbers of
// each surface, which both need. For processors.
struct TwoRays {
  vec4 first, second;
  vec2 first_points[MAX_CROSSINGS], second_points[MAX_CROSSINGS];
};

TwoRays trace_two(vec2 first, vec2 second) {
  TwoRays rays;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) rays.first_points[c] = rays.second_points[c] = vec2(0.0);
  PacketState a = enter(first.x, first.y), b = enter(second.x, second.y);
  for (uint step = 0u; step < path_steps; ++step) {
    advance(a, step, rays.first_points);
    advance(b, step, rays.second_points);
  }
  rays.first = land(a);
  rays.second = land(b);
  return rays;
}
