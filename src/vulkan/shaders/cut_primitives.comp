// SPDX-License-Identifier: Apache-2.0
// Draws the primitives that primitives.comp has listed, one an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#ifdef DIMMED
uint own_grid = 0u;
#endif
#include "primitive_record.glsl"
#include "primitive.glsl"
#ifdef DIMMED
#include "coverage.glsl"
#include "grid_stop.glsl"
#include "primitive_stop.glsl"
#endif
#include "primitive_light.glsl"

shared uint primitive_count;

void draw(Primitive q, uint crossing_count) {
  ivec4 box = pixels_within(q.v);
  if (box.z < box.x || box.w < box.y) return;
  Edges edges = edges_of(q.v, crossing_count);
  for (uint c = 0u; c < crossing_count; ++c) edges.bounds[c] = bounds_about(edges.stops[c]);
  if (is_large(box)) {
    list_large(q, box, crossing_count, edges.bounds, false);
    return;
  }
  vec2 corners[4];
  for (int i = 0; i < 4; ++i) corners[i] = ray_of(q.v[i]).xy;
  for (ivec2 at = box.xy; at.y <= box.w; step_in(box, at)) {
    vec4 w = weights_in(corners, q.is_triangle, at);
#ifdef DIMMED
    float light = dot(w, q.irradiance);
    if (light == 0.0 || is_blocked_at(edges, w, crossing_count)) continue;
    add_light(at, light * behind_stop(corners, q.v, w, crossing_count));
#else
    if (!is_blocked(edges, w)) add_light(at, dot(w, q.irradiance));
#endif
  }
}

// Returns the primitives drawn.
uint emit(uvec4 record) {
  uvec4 v = rays_of(record);
  float flux = flux_of(record);
  uvec3 t = kind_of(record) == IS_FIRST_TRIANGLE ? v.xyz : v.xzw;
  if (failed(ray_of(t.x)) || failed(ray_of(t.y)) || failed(ray_of(t.z))) return 0u;
  Primitive quad, triangle;
  bool is_quad = kind_of(record) == IS_QUAD;
#ifdef DIMMED
  set_grid(record.w);
#endif
  bool has_quad = make_quad(v, flux, quad), has_triangle = make_triangle(t, flux, triangle);
  if (is_quad ? has_quad : has_triangle)
    draw(Primitive(is_quad ? quad.v : triangle.v, is_quad ? quad.irradiance : triangle.irradiance, !is_quad),
         crossings_of(record));
  return 1u;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) primitive_count = 0u;
  barrier();
  uint k = linear_invocation(), drawn = 0u;
  if (k < counters[COUNT_CUT]) drawn = emit(primitives[k]);
  atomicAdd(primitive_count, drawn);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_PRIMITIVES], primitive_count);
}
