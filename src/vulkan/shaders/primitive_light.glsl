// SPDX-License-Identifier: Apache-2.0
// Makes the primitives that open_primitives.comp and cut_primitives.comp draw: PrimitiveBuilder::emit() under the same
// names. Primitives of many pixels are listed, and drawn by tile (large_primitives.comp).
#define SLIVER 1e-7


float twice_area(uint i, uint j, uint k) { return cross2(ray_of(j).xy - ray_of(i).xy, ray_of(k).xy - ray_of(i).xy); }

float extent_squared(uvec4 v) {
  vec2 low = min(min(ray_of(v.x).xy, ray_of(v.y).xy), min(ray_of(v.z).xy, ray_of(v.w).xy));
  vec2 high = max(max(ray_of(v.x).xy, ray_of(v.y).xy), max(ray_of(v.z).xy, ray_of(v.w).xy));
  return dot(high - low, high - low);
}

// False where the area is too small. Corners are put in order.
bool make_quad(uvec4 v, float flux, out Primitive q) {
  float first = twice_area(v.x, v.y, v.z), second = twice_area(v.x, v.z, v.w);
  if (first + second < 0.0) {
    v = v.xwzy;
    float swapped = first;
    first = -second;
    second = -swapped;
  }
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  if (!all(greaterThan(e, vec4(0.0)))) e = vec4(1.0);
  float held = (first * (e.x + e.y + e.z) + second * (e.x + e.z + e.w)) / 6.0;
  q = Primitive(v, e * (flux / held), false);
  return first + second > SLIVER * extent_squared(v);
}

bool make_triangle(uvec3 t, float flux, out Primitive q) {
  float twice = twice_area(t.x, t.y, t.z);
  if (twice < 0.0) {
    t = t.xzy;
    twice = -twice;
  }
  uvec4 v = uvec4(t, t.x);
  q = Primitive(v, vec4(flux / (0.5 * twice)), true);
  return twice > SLIVER * extent_squared(v);
}

bool is_large(ivec4 box) { return (box.z - box.x + 1) * (box.w - box.y + 1) >= p.large_pixels; }

void list_large(Primitive q, ivec4 box, uint crossing_count, uint bounds[MAX_CROSSINGS], bool is_open) {
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
  large[word + 8u] = (q.is_triangle ? 1u : 0u) | (is_open ? 2u : 0u) | (crossing_count << 2u);
#ifdef DIMMED
  large[word + 8u] |= present_grid << LISTED_GRID_SHIFT;
#endif
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) large[word + 9u + c] = bounds[c];
}
