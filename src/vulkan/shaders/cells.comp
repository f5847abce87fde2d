// SPDX-License-Identifier: Apache-2.0
// Draws the open cells of a grid, one cell an invocation: render/bundle/cell_raster.cpp under the same names. Cells of
// many pixels are listed, and drawn by tile (large_cells.comp). Cells that a rim or the iris cuts, and those that are
// no smooth convex quadrilaterals, are listed for cut_cells.comp: they take far longer than others, which would wait
// for them.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#include "bindings.glsl"
#include "light.glsl"
#include "iris.glsl"
#include "quad.glsl"
#include "polygon.glsl"
#include "cell.glsl"
#include "cell_pixels.glsl"
#include "coverage.glsl"
#include "cut_cell.glsl"
#ifdef DIMMED
#include "grid_stop.glsl"
#endif

shared uint primitive_count;
#ifdef DIMMED
uint own_grid;
#endif

// Lists the corners of a large quadrilateral in order.
void list_quad(Density density, ivec4 box, vec2 corners[4], bool is_reversed) {
  uint first = list_large(density, box, 4u);
  if (first == NOT_LISTED) return;
  for (uint k = 0u; k < 4u; ++k) large_corners[first + k] = is_reversed ? corners[3u - k] : corners[k];
}

// Returns false where the cell's triangles are to be drawn in its place. The light of a cell within one pixel is added
// at the same place as that of others, since lavapipe evaluates both sides of a branch.
bool draw_open(uvec4 v, vec4 r[4], vec4 e) {
  vec2 a = r[0].xy - vec2(base), b = r[1].xy - vec2(base), c = r[2].xy - vec2(base), d = r[3].xy - vec2(base);
  float flux = (r[0].z + r[1].z + r[2].z) / 3.0 + (r[0].z + r[2].z + r[3].z) / 3.0;
  vec2 low = min(min(a, b), min(c, d)), high = max(max(a, b), max(c, d));
  bool is_point = floor(low) == floor(high), is_smooth = all(greaterThan(e, vec4(0.0)));
  float area = 0.5 * cross2(c - a, d - b);
  if (!is_point && !(is_smooth && is_convex(a, b, c, d, area))) return false;
  ivec4 box;
  if (!pixels_of(is_point ? floor(low) : low, is_point ? floor(low) + 1.0 : high, box)) return true;
  float value = flux / abs(area);
  vec2 gradient = (p.flags & FLAG_SMOOTH) != 0u && abs(area) >= SHADED_CELL_PX ? gradient_of(v, e) : vec2(0.0);
  Density density = Density((a + b + c + d) * 0.25, value, gradient * value);
  if (is_large(box)) {
    list_quad(density, box, vec2[4](a, b, c, d), area < 0.0);
    return true;
  }
  float orientation = area < 0.0 ? 1.0 : -1.0;
  for (ivec2 at = box.xy; at.y <= box.w; step_in(box, at)) {
    vec2 o = vec2(at);
    float covered = (area_right_of(a - o, b - o) + area_right_of(b - o, c - o)) +
                    (area_right_of(c - o, d - o) + area_right_of(d - o, a - o));
    float light = is_point ? flux : max(covered * orientation, 0.0) * level_at(density, at);
    add_light(at + base, light);
  }
  return true;
}

// Returns the polygons drawn.
uint draw_cell(uint ix, uint iy) {
  uvec4 v = corners_of(1u, ix, iy);
  vec2 s[4];
  for (int k = 0; k < 4; ++k) s[k] = vertex_of(v[k]);
  uvec4 blockers = uvec4(blockers_of(s[0]), blockers_of(s[1]), blockers_of(s[2]), blockers_of(s[3]));
  // A cell is certainly closed only if a single rim or a single crossing of the iris blocks all its corners.
  if ((blockers.x & blockers.y & blockers.z & blockers.w) != 0u) return 0u;
  vec4 r[4];
  for (int k = 0; k < 4; ++k) r[k] = ray_of(v[k]);
  if (!(failed(r[0]) || failed(r[1]) || failed(r[2]) || failed(r[3])) && outside_frame(v)) return 0u;
  bool is_open = (blockers.x | blockers.y | blockers.z | blockers.w) == 0u;
  base = ivec2(clamp(floor(r[0].xy), vec2(0.0), vec2(p.width, p.height)));
#ifdef DIMMED
  uint dims = dimming_of(v, p.crossing_count, failed(r[0]) || failed(r[1]) || failed(r[2]) || failed(r[3]));
  if (dims == DIMMED_TO_NOTHING) return 0u;
  if (dims != 0u) {
    cut_cells[atomicAdd(counters[COUNT_CUT], 1u)] =
        uvec4(v.x, p.side, p.crossing_count | own_grid << CUT_GRID_SHIFT, (is_open ? 1u : 0u) | dims << CUT_DIMS_SHIFT);
    return 0u;
  }
#endif
  if (is_open && draw_open(v, r, vec4(s[0].x, s[1].x, s[2].x, s[3].x))) return 1u;
  cut_cells[atomicAdd(counters[COUNT_CUT], 1u)] =
#ifdef DIMMED
      uvec4(v.x, p.side, p.crossing_count | own_grid << CUT_GRID_SHIFT, is_open ? 1u : 0u);
#else
      uvec4(v.x, p.side, p.crossing_count, is_open ? 1u : 0u);
#endif
  return 0u;
}

void main() {
  uint a_side = p.side - 1u, count = a_side * a_side;
  if (gl_LocalInvocationIndex == 0u) primitive_count = 0u;
  barrier();
  uint k = linear_invocation(), primitives = 0u;
  if (k < p.grid_count * count) {
    first_ray = p.first_ray + k / count * p.side * p.side;
#ifdef DIMMED
    own_grid = p.first_grid + k / count;
    set_grid(own_grid);
#endif
    k %= count;
    primitives = draw_cell(k % a_side, k / a_side);
  }
  atomicAdd(primitive_count, primitives);
  barrier();
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_PRIMITIVES], primitive_count);
}
