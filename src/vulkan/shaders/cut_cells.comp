// SPDX-License-Identifier: Apache-2.0
// Draws the cells that cells.comp has listed, one triangle an invocation: clips it by rims and the iris.
// render/bundle/cell_raster.cpp under the same names.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#include "clip_triangle.glsl"
#include "cell.glsl"
#include "cell_pixels.glsl"
#include "coverage.glsl"
#include "cut_cell.glsl"
#ifdef DIMMED
#include "grid_stop.glsl"
#include "picture_cuts.glsl"
#include "dirt_cuts.glsl"
uint dims = 0u;  // what dims the present cell
bool draws_points = true;  // polygons within a pixel; those of a larger triangle have its gradient

vec2 middle_of_polygon() {
  vec2 sum = vec2(0.0);
  for (int k = 0; k < corner_count; ++k) sum += polygon[k];
  return sum / float(corner_count);
}
#endif

shared uint primitive_count;

// Lists the invocation's polygon, whose shoelace area is then positive.
void list_polygon(Density density, ivec4 box) {
  uint first = list_large(density, box, uint(corner_count));
  if (first == NOT_LISTED) return;
  bool is_reversed = twice_polygon_area() < 0.0;
  for (int k = 0; k < corner_count; ++k)
    large_corners[first + uint(k)] = polygon[is_reversed ? corner_count - 1 - k : k];
}

// A line's flux by length, in steps of at most half a pixel.
void add_line(vec2 from, vec2 to, float flux) {
  int steps = clamp(int(ceil(2.0 * length(to - from))), 1, 8192);
  for (int k = 0; k < steps; ++k) {
    ivec2 pixel = ivec2(floor(mix(from, to, (float(k) + 0.5) / float(steps)))) + base;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= p.width || pixel.y >= p.height) continue;
    add_light(pixel, flux / float(steps));
  }
}

// The invocation's polygon, with an irradiance that is linear over it.
void add_polygon(Density density) {
  vec2 low = polygon[0], high = polygon[0];
  for (int k = 1; k < corner_count; ++k) {
    low = min(low, polygon[k]);
    high = max(high, polygon[k]);
  }
  ivec4 box;
  if (!pixels_of(low, high, box)) return;
  if (is_large(box)) {
    list_polygon(density, box);
    return;
  }
  float orientation = twice_polygon_area() < 0.0 ? 1.0 : -1.0;
  for (ivec2 at = box.xy; at.y <= box.w; step_in(box, at)) {
    vec2 corner = vec2(at);
    float covered = 0.0;
    for (int k = 0; k < corner_count; ++k)
      covered += area_right_of(polygon[k] - corner, polygon[k + 1 == corner_count ? 0 : k + 1] - corner);
#ifdef DIMMED
    covered *= orientation;
    if (covered <= NEGLIGIBLE_COVERAGE) continue;
    add_light(at + base, covered * level_at(density, at) * (dims == 0u ? 1.0 : transmitted_at(dims, corner + 0.5)));
#else
    if (covered * orientation > 0.0) add_light(at + base, covered * orientation * level_at(density, at));
#endif
  }
}

// The open part of a triangle's image. fraction: the part's fraction of the triangle's flux.
void draw_polygon(vec2 p0, vec2 p1, vec2 p2, float flux, float fraction, vec2 gradient) {
  float area = abs(0.5 * cross2(p1 - p0, p2 - p0));
  vec2 from = polygon[0], to = polygon[0];
#ifdef DIMMED
  bool is_point = draws_points && in_one_pixel();
#else
  bool is_point = in_one_pixel();
#endif
  if (!is_point) farthest_corners(from, to);
  // A polygon in one pixel is a line of one step.
  if (is_point || area < SLIVER * dot(to - from, to - from)) {
#ifdef DIMMED
    if (dims != 0u) flux *= transmitted_at(dims, middle_of_polygon());
#endif
    add_line(from, to, flux * fraction);
    return;
  }
  float value = flux / area;
  add_polygon(Density((p0 + p1 + p2) * (1.0 / 3.0), value, gradient * value));
}

void clip_whole(uint crossing_count, bool is_cut) {
  begin_triangle();
  if (is_cut)
    clip_triangle(crossing_count);
  else
    keep_few();
}

// Draws the invocation's polygon in (u, v), a part of a triangle of rays.
void draw_part(vec2 p0, vec2 p1, vec2 p2, float flux, vec2 gradient) {
  float fraction = abs(twice_polygon_area());  // in (u, v) the whole triangle's area is 1/2
  for (int k = 0; k < corner_count; ++k) polygon[k] = p0 + (p1 - p0) * polygon[k].x + (p2 - p0) * polygon[k].y;
  draw_polygon(p0, p1, p2, flux, fraction, gradient);
}

#ifdef DIMMED
// Leaves the open part of a part of the triangle.
void clip_part(vec2 corner, float size, uint crossing_count, bool is_cut) {
  begin_part(corner, size);
  bool by_picture = HAS_PICTURE && (dims & CLIPPED_BY_PICTURE) != 0u;
  if (by_picture) clip_by_rims();
  for (uint c = 0u; c < crossing_count && by_picture && corner_count >= 3; ++c) clip_by_picture(c, corner, size);
  if (is_cut && !by_picture)
    clip_triangle(crossing_count);
  else
    end_cuts();
}

vec2 place_in_pixels(vec2 p[3], vec2 place) { return p[0] + (p[1] - p[0]) * place.x + (p[2] - p[0]) * place.y; }

// Whether the invocation's polygon, in (u, v), lies in one pixel: it has the mean of the dirt about its middle.
bool is_within_pixel(vec2 p[3]) {
  vec2 first = floor(place_in_pixels(p, polygon[0]));
  for (int k = 1; k < corner_count; ++k)
    if (floor(place_in_pixels(p, polygon[k])) != first) return false;
  return true;
}

// Draws a triangle in parts, each with its shadows. Returns the polygons drawn.
uint draw_parts(vec2 p[3], uint crossing_count, bool is_cut, float flux, vec2 gradient) {
  bool has_shadows = (dims & CUT_BY_DIRT) != 0u, by_picture = (dims & CLIPPED_BY_PICTURE) != 0u;
  if (has_shadows && !by_picture) {
    clip_whole(crossing_count, is_cut);
    if (corner_count < 3) return 0u;
    if (is_within_pixel(p)) {
      draw_part(p[0], p[1], p[2], flux * dirt_at(place_of(place_in_pixels(p, middle_of_polygon()))), gradient);
      return 1u;
    }
    draws_points = false;
  }
  int parts = by_picture ? picture_parts(p, crossing_count) : 1;
  if (has_shadows) parts = max(parts, shadow_parts(p));
  uint drawn = 0u;
  int k = 0;
  for (; k < parts * parts; ++k) {
    vec2 corner;
    float size;
    find_part(k, parts, corner, size);
    unshadowed = 1.0;
    if (has_shadows) find_shadows(corner, size);
    for (int term = 0; term < shadow_terms(); ++term) {
      ivec2 shadows = shadows_of_term(term);
      clip_part(corner, size, crossing_count, is_cut);
      if (corner_count < 3) break;
      bool is_point = has_shadows && by_picture && is_within_pixel(p);
      if (is_point) unshadowed = dirt_at(place_of(place_in_pixels(p, middle_of_polygon())));
      cut_by_shadows(shadows, corner, size);
      if (corner_count < 3) continue;
      draw_part(p[0], p[1], p[2], flux * factor_of_term(shadows), gradient);
      ++drawn;
      if (is_point) break;
    }
  }
  if (k < parts * parts) atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_TURNS);
  return drawn;
}
#endif

// Returns the polygons drawn.
uint draw_triangle(uvec3 t, uint crossing_count, bool is_cut, vec2 gradient) {
  vec4 r0 = ray_of(t.x), r1 = ray_of(t.y), r2 = ray_of(t.z);
  if (failed(r0) || failed(r1) || failed(r2)) return 0u;
  vec2 p0 = r0.xy - vec2(base), p1 = r1.xy - vec2(base), p2 = r2.xy - vec2(base);
  float flux = (r0.z + r1.z + r2.z) / 3.0;
  set_triangle(t, crossing_count);
#ifdef DIMMED
  if (dims != 0u) see_triangle(t, crossing_count, vec2(base));
  return draw_parts(vec2[3](p0, p1, p2), crossing_count, is_cut, flux, gradient);
#else
  clip_whole(crossing_count, is_cut);
  if (corner_count < 3) return 0u;
  draw_part(p0, p1, p2, flux, gradient);
  return 1u;
#endif
}

uint draw_half(uvec4 cell, bool is_second) {
  uint side = cell.y;
  uvec4 v = cell.x + uvec4(0u, 1u, side + 1u, side);
  vec4 r[4];
  for (int k = 0; k < 4; ++k) r[k] = ray_of(v[k]);
  bool any_failed = failed(r[0]) || failed(r[1]) || failed(r[2]) || failed(r[3]);
  vec2 near = failed(r[0]) ? r[2].xy : r[0].xy;
  base = ivec2(clamp(floor(near), vec2(0.0), vec2(p.width, p.height)));
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  float area = any_failed ? 0.0 : 0.5 * cross2(r[2].xy - r[0].xy, r[3].xy - r[1].xy);
  vec2 gradient = vec2(0.0);
  if ((p.flags & FLAG_SMOOTH) != 0u && all(greaterThan(e, vec4(0.0))) && abs(area) >= SHADED_CELL_PX)
    gradient = gradient_of(v, e);
#ifdef DIMMED
  uint crossing_count = cell.z & ((1u << CUT_GRID_SHIFT) - 1u), grid = cell.z >> CUT_GRID_SHIFT;
  set_grid(grid);
  clips_by_circle = grid_pattern != 0u;
  dims = cell.w >> CUT_DIMS_SHIFT;
  seen_triangle = seen_words(cell.x, dims, crossing_count, is_second, grid);
  return draw_triangle(is_second ? v.xzw : v.xyz, crossing_count, (cell.w & 1u) == 0u, gradient);
#else
  return draw_triangle(is_second ? v.xzw : v.xyz, cell.z, cell.w == 0u, gradient);
#endif
}

void main() {
  if (gl_LocalInvocationIndex == 0u) primitive_count = 0u;
  barrier();
  uint k = linear_invocation(), primitives = 0u;
  if (k < 2u * counters[COUNT_CUT]) primitives = draw_half(cut_cells[k / 2u], k % 2u == 1u);
  atomicAdd(primitive_count, primitives);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_PRIMITIVES], primitive_count);
}
