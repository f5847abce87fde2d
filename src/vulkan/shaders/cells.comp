// SPDX-License-Identifier: Apache-2.0
// Draws the cells of a grid, one cell an invocation: render/bundle/cell_raster.cpp under the same names. Cells of many
// pixels are listed, and drawn by tile (large_cells.comp).
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#include "polygon.glsl"
#include "cell.glsl"
#include "coverage.glsl"

#define LARGE_PX 64  // pixels of the bounds from which on a polygon is listed

shared uint primitive_count;
uint primitives;

uint ray_at(uint ix, uint iy) { return p.first_ray + iy * p.side + ix; }
float triangle_flux(uvec3 t) { return p.triangle_weight * (rays[t.x].z + rays[t.y].z + rays[t.z].z) / 3.0; }

void add_point(vec2 at, float flux) {
  ivec2 pixel = ivec2(floor(at)) + base;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= p.width || pixel.y >= p.height) return;
  add_light(pixel.x, pixel.y, flux);
}

// A line's flux by length, in steps of at most half a pixel.
void add_line(vec2 from, vec2 to, float flux) {
  int steps = clamp(int(ceil(2.0 * length(to - from))), 1, 8192);
  for (int k = 0; k < steps; ++k) add_point(mix(from, to, (float(k) + 0.5) / float(steps)), flux / float(steps));
}

// Lists the polygon, whose shoelace area is then positive. If memory does not suffice, the host draws the frame again
// in smaller parts.
void list_large(Density density, ivec4 box) {
  uint at = atomicAdd(counters[COUNT_POLYGONS], 1u);
  uint first = atomicAdd(counters[COUNT_CORNERS], uint(corner_count));
  if (at >= p.large_capacity || first + uint(corner_count) > p.corner_capacity) {
    atomicOr(counters[COUNT_OVERFLOWS], OVERFLOW_POLYGONS);
    return;
  }
  uint word = 16u * at;
  large[word] = floatBitsToUint(density.value);
  large[word + 1u] = floatBitsToUint(density.gradient.x);
  large[word + 2u] = floatBitsToUint(density.gradient.y);
  large[word + 3u] = floatBitsToUint(density.point.x);
  large[word + 4u] = floatBitsToUint(density.point.y);
  for (uint c = 0u; c < 3u; ++c) large[word + 5u + c] = floatBitsToUint(p.gain[c]);
  large[word + 8u] = first;
  large[word + 9u] = uint(corner_count);
  large[word + 10u] = uint(base.x);
  large[word + 11u] = uint(base.y);
  for (uint k = 0u; k < 4u; ++k) large[word + 12u + k] = uint(box[k]);
  bool is_reversed = twice_polygon_area() < 0.0;
  for (int k = 0; k < corner_count; ++k)
    large_corners[first + uint(k)] = polygon[is_reversed ? corner_count - 1 - k : k];
}

// The frame's pixels within bounds, as (first, last); false if there are none. The bounds are clamped before they are
// converted: a ghost may be far larger than an integer.
bool pixels_of(vec2 low, vec2 high, out ivec4 box) {
  vec2 frame_low = -vec2(base), frame_high = vec2(p.width, p.height) - vec2(base);
  if (!(high.x > frame_low.x && low.x < frame_high.x && high.y > frame_low.y && low.y < frame_high.y)) return false;
  ivec2 first = ivec2(floor(max(low, frame_low))), last = ivec2(ceil(min(high, frame_high))) - 1;
  last = min(max(last, first), ivec2(frame_high) - 1);
  box = ivec4(first, last);
  return last.x >= first.x && last.y >= first.y;
}

bool is_large(ivec4 box) { return (box.z - box.x + 1) * (box.w - box.y + 1) >= LARGE_PX; }

void add_covered(int x, int y, float covered, Density density) {
  if (covered <= 0.0) return;
  float level = density.value + dot(density.gradient, vec2(x, y) + 0.5 - density.point);
  add_light(x + base.x, y + base.y, covered * level);
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
    list_large(density, box + base.xyxy);
    return;
  }
  float orientation = twice_polygon_area() < 0.0 ? 1.0 : -1.0;
  for (int y = box.y; y <= box.w; ++y) {
    for (int x = box.x; x <= box.z; ++x) {
      vec2 corner = vec2(x, y);
      float covered = 0.0;
      for (int k = 0; k < corner_count; ++k)
        covered += area_right_of(polygon[k] - corner, polygon[k + 1 == corner_count ? 0 : k + 1] - corner);
      add_covered(x, y, covered * orientation, density);
    }
  }
}

// The same for four corners, which need no array in memory.
void add_quad(vec2 a, vec2 b, vec2 c, vec2 d, float area, Density density) {
  ivec4 box;
  if (!pixels_of(min(min(a, b), min(c, d)), max(max(a, b), max(c, d)), box)) return;
  if (is_large(box)) {
    polygon[0] = a;
    polygon[1] = b;
    polygon[2] = c;
    polygon[3] = d;
    corner_count = 4;
    list_large(density, box + base.xyxy);
    return;
  }
  float orientation = area < 0.0 ? 1.0 : -1.0;
  for (int y = box.y; y <= box.w; ++y) {
    for (int x = box.x; x <= box.z; ++x) {
      vec2 o = vec2(x, y);
      float covered = (area_right_of(a - o, b - o) + area_right_of(b - o, c - o)) +
                      (area_right_of(c - o, d - o) + area_right_of(d - o, a - o));
      add_covered(x, y, covered * orientation, density);
    }
  }
}

// A part of a triangle's image. fraction: the part's fraction of the triangle's flux.
void draw_polygon(uvec3 t, float fraction, vec2 gradient) {
  vec2 p0 = pixel_of(t.x), p1 = pixel_of(t.y), p2 = pixel_of(t.z);
  float area = abs(0.5 * cross2(p1 - p0, p2 - p0));
  float flux = triangle_flux(t);
  ++primitives;
  if (in_one_pixel()) {
    add_point(polygon[0], flux * fraction);
    return;
  }
  vec2 from, to;
  farthest_corners(from, to);
  if (area < SLIVER * dot(to - from, to - from)) {
    add_line(from, to, flux * fraction);
    return;
  }
  float value = flux / area;
  add_polygon(Density((p0 + p1 + p2) * (1.0 / 3.0), value, gradient * value));
}

void draw_triangle(uvec3 t, bool is_cut, vec2 gradient) {
  if (failed(rays[t.x]) || failed(rays[t.y]) || failed(rays[t.z])) return;
  vec2 p0 = pixel_of(t.x), p1 = pixel_of(t.y), p2 = pixel_of(t.z);
  float fraction = 1.0;
  if (is_cut) {
    set_triangle(t, p.crossing_count);
    clip_triangle(p.crossing_count);
    if (corner_count < 3) return;
    fraction = abs(twice_polygon_area());  // in (u, v) the whole triangle's area is 1/2
    for (int k = 0; k < corner_count; ++k) polygon[k] = p0 + (p1 - p0) * polygon[k].x + (p2 - p0) * polygon[k].y;
  } else {
    polygon[0] = p0;
    polygon[1] = p1;
    polygon[2] = p2;
    corner_count = 3;
  }
  draw_polygon(t, fraction, gradient);
}

// Returns false where the cell's triangles are to be drawn in its place.
bool draw_open(uvec4 v, bool is_smooth, float area, vec2 gradient) {
  vec2 a = pixel_of(v.x), b = pixel_of(v.y), c = pixel_of(v.z), d = pixel_of(v.w);
  float flux = triangle_flux(v.xyz) + triangle_flux(v.xzw);
  if (floor(a) == floor(b) && floor(a) == floor(c) && floor(a) == floor(d)) {
    ++primitives;
    add_point(a, flux);
    return true;
  }
  if (!is_smooth || !is_convex(a, b, c, d, area)) return false;
  float value = flux / abs(0.5 * cross2(c - a, d - b));
  ++primitives;
  add_quad(a, b, c, d, area, Density((a + b + c + d) * 0.25, value, gradient * value));
  return true;
}

void draw_cell(uint ix, uint iy) {
  uvec4 v = uvec4(ray_at(ix, iy), ray_at(ix + 1u, iy), ray_at(ix + 1u, iy + 1u), ray_at(ix, iy + 1u));
  int state = state_of(v, p.crossing_count);
  if (state == STATE_CLOSED) return;
  bool any_failed = failed(rays[v.x]) || failed(rays[v.y]) || failed(rays[v.z]) || failed(rays[v.w]);
  if (!any_failed && outside_frame(v)) return;
  vec2 near = failed(rays[v.x]) ? rays[v.z].xy : rays[v.x].xy;
  base = ivec2(clamp(floor(near), vec2(0.0), vec2(p.width, p.height)));
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  bool is_smooth = all(greaterThan(e, vec4(0.0)));
  float area = any_failed ? 0.0 : 0.5 * cross2(rays[v.z].xy - rays[v.x].xy, rays[v.w].xy - rays[v.y].xy);
  vec2 gradient = vec2(0.0);
  if ((p.flags & FLAG_SMOOTH) != 0u && is_smooth && abs(area) >= SHADED_CELL_PX) gradient = gradient_of(v, e);
  if (state == STATE_OPEN && draw_open(v, is_smooth, area, gradient)) return;
  // One call in a loop, since compilers copy a function's code into each place that calls it.
  for (uint half_cell = 0u; half_cell < 2u; ++half_cell)
    draw_triangle(half_cell == 0u ? v.xyz : v.xzw, state == STATE_CUT, gradient);
}

void main() {
  uint cells = p.side - 1u;
  if (gl_LocalInvocationIndex == 0u) primitive_count = 0u;
  barrier();
  primitives = 0u;
  uint k = linear_invocation();
  if (k < cells * cells) draw_cell(k % cells, k / cells);
  atomicAdd(primitive_count, primitives);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_PRIMITIVES], primitive_count);
}
