// SPDX-License-Identifier: Apache-2.0
// Draws the open primitives that primitives.comp has listed, one an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#include "primitive_record.glsl"
#include "primitive.glsl"
#include "primitive_light.glsl"

void draw(Primitive q) {
  ivec4 box = pixels_within(q.v);
  if (box.z < box.x || box.w < box.y) return;
  if (is_large(box)) {
    list_large(q, box, 0u, uint[MAX_CROSSINGS](0u, 0u, 0u), true);
    return;
  }
  vec2 corners[4];
  for (int i = 0; i < 4; ++i) corners[i] = ray_of(q.v[i]).xy;
  for (ivec2 at = box.xy; at.y <= box.w; step_in(box, at))
    add_light(at, dot(weights_in(corners, false, at), q.irradiance));
}

void main() {
  uint k = linear_invocation(), count = counters[COUNT_OPEN];
  if (k == 0u) atomicAdd(counters[COUNT_PRIMITIVES], count);
  if (k >= count) return;
  uvec4 record = primitives[open_place(k)];
  Primitive q;
  if (make_quad(rays_of(record), flux_of(record), q)) draw(q);
}
