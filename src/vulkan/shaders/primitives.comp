// SPDX-License-Identifier: Apache-2.0
// Makes the primitives of a level of merging and draws the small ones; those of many pixels are listed, and drawn by
// tile (large_primitives.comp). PrimitiveBuilder::emit() under the same names.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#include "quad.glsl"
#include "primitive.glsl"

#define SLIVER 1e-7
#define LARGE_PX 64
#define BLOCK_PARTED -2.0

shared uint primitive_count;
uint primitives;

float twice_area(uint i, uint j, uint k) { return cross2(rays[j].xy - rays[i].xy, rays[k].xy - rays[i].xy); }

float extent_squared(uvec4 v) {
  vec2 low = min(min(rays[v.x].xy, rays[v.y].xy), min(rays[v.z].xy, rays[v.w].xy));
  vec2 high = max(max(rays[v.x].xy, rays[v.y].xy), max(rays[v.z].xy, rays[v.w].xy));
  return dot(high - low, high - low);
}

void list_large(Primitive q, ivec4 box) {
  uint at = atomicAdd(counters[COUNT_POLYGONS], 1u);
  if (at >= p.large_capacity) {
    atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_POLYGONS);
    return;
  }
  uint word = 16u * at;
  for (uint k = 0u; k < 4u; ++k) {
    large[word + k] = q.v[k];
    large[word + 4u + k] = floatBitsToUint(q.irradiance[k]);
    large[word + 12u + k] = uint(box[k]);
  }
  large[word + 8u] = (q.is_triangle ? 1u : 0u) | (q.is_open ? 2u : 0u) | (p.crossing_count << 2u);
  for (uint c = 0u; c < 3u; ++c) large[word + 9u + c] = floatBitsToUint(p.gain[c]);
}

void draw(Primitive q) {
  ivec4 box = pixels_within(q.v);
  if (box.z < box.x || box.w < box.y) return;
  ivec2 extent = box.zw - box.xy + 1;
  if (extent.x * extent.y >= LARGE_PX) {
    list_large(q, box);
    return;
  }
  for (int y = box.y; y <= box.w; ++y) {
    for (int x = box.x; x <= box.z; ++x) {
      float flux = light_at(q, ivec2(x, y), p.crossing_count);
      if (flux != 0.0) add_light(x, y, flux);
    }
  }
}

bool all_open(uvec4 v) {
  return passes(v.x) && passes(v.y) && passes(v.z) && passes(v.w);
}

void emit_quad(uvec4 v, float flux) {
  float first = twice_area(v.x, v.y, v.z), second = twice_area(v.x, v.z, v.w);
  if (first + second < 0.0) {
    v = v.xwzy;
    float swapped = first;
    first = -second;
    second = -swapped;
  }
  ++primitives;
  if (!(first + second > SLIVER * extent_squared(v))) return;
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  if (!all(greaterThan(e, vec4(0.0)))) e = vec4(1.0);
  float held = (first * (e.x + e.y + e.z) + second * (e.x + e.z + e.w)) / 6.0;
  draw(Primitive(v, e * (flux / held), false, all_open(v)));
}

void emit_triangle(uvec3 t) {
  if (failed(rays[t.x]) || failed(rays[t.y]) || failed(rays[t.z])) return;
  float flux = p.triangle_weight * (rays[t.x].z + rays[t.y].z + rays[t.z].z) / 3.0;
  float twice = twice_area(t.x, t.y, t.z);
  if (twice < 0.0) {
    t = t.xzy;
    twice = -twice;
  }
  ++primitives;
  uvec4 v = uvec4(t, t.x);
  if (!(twice > SLIVER * extent_squared(v))) return;
  draw(Primitive(v, vec4(flux / (0.5 * twice)), true, all_open(v)));
}

// Whether the block is a part of a whole block of the next level, whose side is finer_side and place finer_at here.
bool is_merged(uint ix, uint iy) {
  if ((p.flags & FLAG_LAST_LEVEL) != 0u) return false;
  uint jx = ix / 2u, jy = iy / 2u;
  return jx < p.finer_side && jy < p.finer_side && blocks[p.finer_at + jy * p.finer_side + jx] >= 0.0;
}

void emit(uint ix, uint iy) {
  float value = blocks[p.blocks_at + iy * p.level_side + ix];
  uvec4 v = corners_of(1u << p.level, ix, iy);
  if (value >= 0.0) {
    if (!is_merged(ix, iy)) emit_quad(v, value);
  } else if (p.level == 0u && value == BLOCK_PARTED) {
    emit_triangle(v.xyz);
    emit_triangle(v.xzw);
  }
}

void main() {
  if (gl_LocalInvocationIndex == 0u) primitive_count = 0u;
  barrier();
  primitives = 0u;
  uint k = linear_invocation();
  if (k < p.level_side * p.level_side) emit(k % p.level_side, k / p.level_side);
  atomicAdd(primitive_count, primitives);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_PRIMITIVES], primitive_count);
}
