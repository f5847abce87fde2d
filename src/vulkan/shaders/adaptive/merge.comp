// SPDX-License-Identifier: Apache-2.0
// Lists blocks of 4 x 4 or 2 x 2 open cells as one quadrilateral where a plane serves all of them, since tiles take most of
// a frame: one block of 4 x 4 an invocation. cells.comp leaves these cells out.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "../polygon.glsl"
#include "../cell.glsl"
#include "bent_image.glsl"
#include "list.glsl"
#include "state.glsl"
#include "merged.glsl"
#include "parts.glsl"

uint number;  // of the block in the item
uint cells;   // a side of what is examined: 4 or 2
uvec4 rays_at_corners;
float flux;  // in units of 2 * triangle_weight, as irradiances
bool is_in_pixel;

// False where no block has the invocation's number.
bool find_block() {
  uint k = linear_group() * 64u + gl_LocalInvocationID.x, block = k / BLOCKS_OF_RAYS;
  if (block >= counters[COUNT_BLOCKS]) return false;
  item = item_of_block(block);
  side = cells_of(item) + 1u;
  first_ray = 64u * offset_of(item);
  number = BLOCKS_OF_RAYS * (block - offset_of(item)) + k % BLOCKS_OF_RAYS;
  return number < blocks_a_side(side) * blocks_a_side(side);
}

// Simpson's weights, by the cells a side.
float weight_of(uint k) {
  return (k == 0u || k == cells ? 1.0 : (k & 1u) != 0u ? 4.0 : 2.0) * (1.0 / 3.0);
}

// Sets the flux. False if a ray is blocked, or if the map is not smooth about it.
bool find_flux(uint first) {
  bool is_open = true, is_smooth = true;
  ivec2 pixel = ivec2(floor(clamp(ray_of(first).xy, vec2(-1.0e6), vec2(1.0e6))));
  flux = 0.0;
  is_in_pixel = true;
  for (uint k = 0u; k < (cells + 1u) * (cells + 1u); ++k) {
    uint ix = k % (cells + 1u), iy = k / (cells + 1u), ray = first + iy * side + ix;
    vec4 at = ray_of(ray);
    is_open = is_open && !failed(at) && passes(ray);
    is_smooth = is_smooth && irradiance_at(ray) > 0.0;
    is_in_pixel = is_in_pixel && floor(at.xy) == vec2(pixel);
    flux += weight_of(ix) * weight_of(iy) * at.z;
  }
  return is_open && (is_smooth || is_in_pixel);
}

float distance_to_line(vec2 at, vec2 from, vec2 to) {
  return abs(cross2(at - from, to - from)) / max(length(to - from), 1e-6);
}

// Whether a plane is within the error at all rays, and the rays of the sides are near straight lines.
bool plane_serves(uint first, Density density, float allowed) {
  uvec4 v = rays_at_corners;
  vec2 a = pixel_of(v.x), b = pixel_of(v.y), c = pixel_of(v.z), d = pixel_of(v.w);
  float off = 0.0, aside = 0.0;
  for (uint k = 0u; k < (cells + 1u) * (cells + 1u); ++k) {
    uint ix = k % (cells + 1u), iy = k / (cells + 1u), ray = first + iy * side + ix;
    vec2 at = pixel_of(ray);
    off = max(off, abs(density.value + dot(density.gradient, at - density.point) - irradiance_at(ray)));
    if (iy == 0u) aside = max(aside, distance_to_line(at, a, b));
    if (iy == cells) aside = max(aside, distance_to_line(at, d, c));
    if (ix == 0u) aside = max(aside, distance_to_line(at, a, d));
    if (ix == cells) aside = max(aside, distance_to_line(at, b, c));
  }
  return off <= allowed && aside * density.value <= allowed;
}

// The change of the gains from the middle of a block to its rim.
vec3 gain_change() {
  vec2 half_mm = 0.5 * float(cells) / float(side - 1u) * state_box(item).zw;
  vec3 change;
  for (uint c = 0u; c < 3u; ++c)
    change[c] = abs(state(item, STATE_SLOPES + c)) * half_mm.x + abs(state(item, STATE_SLOPES + 3u + c)) * half_mm.y;
  return change;
}

// Finds the bulges of the sides of a block, which its rays show.
Bulges find_bulges(uint first, vec2 a, vec2 b, vec2 c, vec2 d) {
  Bulges bulges = Bulges(0.0, vec2(0.0));
  vec2 ab = vec2(0.0), bc = vec2(0.0), cd = vec2(0.0), da = vec2(0.0);  // mean distances, by Simpson
  for (uint k = 1u; k < cells; ++k) {
    float t = float(k) / float(cells), weight = weight_of(k) / float(cells);
    uint by_row = k, by_column = k * side;
    ab += weight * (pixel_of(first + by_row) - mix(a, b, t));
    bc += weight * (pixel_of(first + cells + by_column) - mix(b, c, t));
    cd += weight * (pixel_of(first + cells * side + by_row) - mix(d, c, t));
    da += weight * (pixel_of(first + by_column) - mix(a, d, t));
  }
  add_bulge(bulges, a, b, ab);
  add_bulge(bulges, b, c, bc);
  add_bulge(bulges, c, d, cd);
  add_bulge(bulges, d, a, da);
  return bulges;
}

// Lists the block that begins at a ray. False if its cells are to be drawn by themselves.
bool list_block(uvec2 at) {
  uint first = ray_at(at.x, at.y);
  uvec4 v = first + uvec4(0u, cells, cells * side + cells, cells * side);
  rays_at_corners = v;
  if (!find_flux(first)) return false;
  if (outside_frame(v)) return false;  // its sides may bend into the frame
  own = at.y * side + at.x;
  set_block(v, cells);
  float unit = 2.0 * triangle_weight;
  if (is_in_pixel) {
    list_point(pixel_of(v.x), unit * flux);
    return true;
  }
  vec2 a = pixel_of(v.x), b = pixel_of(v.y), c = pixel_of(v.z), d = pixel_of(v.w);
  float area = 0.5 * cross2(c - a, d - b);
  if (!is_convex(a, b, c, d, area)) return false;
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  bool shaded = is_shaded(area, e);
  Bulges bulges = Bulges(0.0, vec2(0.0));
  if (shaded) bulges = find_bulges(first, a, b, c, d);
  vec2 gradient = shaded ? gradient_of(v, e) : vec2(0.0);
  Density density = density_of(flux, area, centroid_of(a, b, c, d), bulges, gradient);
  vec3 change = gain_change(), largest = abs(gain) + change;
  float allowed = p.merge_error * frame_peak() / unit;  // times gains
  if (density.value * max(max(change.x, change.y), change.z) > allowed) return false;
  if (!plane_serves(first, density, allowed / max(max(max(largest.x, largest.y), largest.z), 1e-37))) return false;
  density.value *= unit;
  density.gradient *= unit;
  list_quad(a, b, c, d, density);
  return true;
}

void main() {
  if (!find_block()) return;
  uint mask = 0u;
  uvec2 at = BLOCK_CELLS * uvec2(number % blocks_a_side(side), number / blocks_a_side(side));
  if (pattern_of(item) == 0u) {
    cells = BLOCK_CELLS;
    if (list_block(at)) mask = WHOLE_BLOCK;
    cells = BLOCK_CELLS / 2u;
    for (uint k = 0u; k < 4u && (mask & WHOLE_BLOCK) == 0u; ++k)
      if (list_block(at + cells * uvec2(k & 1u, k >> 1u))) mask |= 1u << k;
  }
  blocks[BLOCKS_OF_RAYS * offset_of(item) + number] = float(mask);
}
