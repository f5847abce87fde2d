// SPDX-License-Identifier: Apache-2.0
// One level of the search for the pupils of all groups: render/pupils/window_search.cpp. A workgroup traces 16 x 16 rays,
// one an invocation, of a box of such blocks, and bounds the cells through which light may pass.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
#define GEOMETRY_ONLY
#include "common.glsl"
#include "item_path.glsl"
#include "near_stop.glsl"
#include "../stop/pattern_record.glsl"

#define SCAN_REACH 0.5       // cells on each side of a hit
#define OUTER_SCAN_REACH 4.0  // where no grid has been searched
#define SHRINK_ENOUGH 0.85  // the search goes on while a level shrinks the area below this fraction

// Each ray's relative height - 1, FAILED where it fails, and where it crosses the stop first; later crossings.
shared vec3 corners[256];
shared vec2 later_stops[MAX_CROSSINGS - 1u][256];
shared uint bounds_found[8];  // as found[]

// A workgroup's rays lie on a grid of cells or, if it scans, on a line.
struct RaySet {
  bool scans;
  vec2 first, step_x, step_y;  // mm from the point of the start, by the sides of the box
  vec2 window;                 // its size, mm; rays of a scan that begin outside do not count
  vec2 side;                   // the direction of the box's first side
};

vec2 place_of(RaySet rays, uint k) {
  vec2 by = rays.scans ? vec2(k, 0u) : vec2(k & 15u, k >> 4u);
  return rays.first + by.x * rays.step_x + by.y * rays.step_y;
}

bool counts(RaySet rays, vec2 place) {
  return !rays.scans || (all(greaterThanEqual(place, vec2(0.0))) && all(lessThanEqual(place, rays.window)));
}

void keep_corner(uint k, bool counted, vec4 ray, vec2 points[MAX_CROSSINGS]) {
  corners[k] = vec3(points[0], failed(ray) || !counted ? FAILED : ray.w - 1.0);
  for (uint c = 1u; c < MAX_CROSSINGS; ++c)
    if (c < crossings_of(path_item)) later_stops[c - 1u][k] = points[c];
}

// Traces the rays of a workgroup, one an invocation; on processors half of the invocations trace two rays each.
void trace_corners(uint item, RaySet rays) {
  uint k = gl_LocalInvocationIndex;
  set_path(item);
  vec2 place = place_of(rays, k);
  if (!ON_PROCESSOR) {
    vec2 from = in_lens_frame(rays.side, place);
    vec4 ray = trace_ray(from.x, from.y);
    keep_corner(k, counts(rays, place), ray, stop_points);
    return;
  }
  if (k >= 128u) return;
  vec2 other_place = place_of(rays, k + 128u);
  TwoRays two = trace_two(in_lens_frame(rays.side, place), in_lens_frame(rays.side, other_place));
  keep_corner(k, counts(rays, place), two.first, two.first_points);
  keep_corner(k + 128u, counts(rays, other_place), two.second, two.second_points);
}

// Beside failing rays the others count by their distances.
bool near_stop_beside_failing(vec2 q[4], bvec4 good, float radius) {
  vec2 distance = vec2(FAILED, -FAILED);
  for (int k = 0; k < 4; ++k) {
    float here = length(q[k]) - radius;
    if (good[k]) distance = vec2(min(distance.x, here), max(distance.y, here));
  }
  return distance.x <= max(0.0, distance.y - distance.x);
}

// Whether light may pass a cell's rim: where the relative height does not fall below its lowest corner by more than the
// corners differ (open_cells.h). Corners whose rays fail are ignored.
bool may_pass_rim(vec4 height, bvec4 good) {
  vec2 bounds = vec2(FAILED, -FAILED);
  for (int k = 0; k < 4; ++k)
    if (good[k]) bounds = vec2(min(bounds.x, height[k]), max(bounds.y, height[k]));
  return any(good) && bounds.x <= max(0.0, bounds.y - bounds.x);
}

#define PASSES 0u
#define MAY_PASS 4u

// Reports light within bounds, in cells of what is searched.
void report(uint kind, vec2 low, vec2 high, uvec2 cells) {
  uvec2 first = uvec2(clamp(floor(low), vec2(0.0), vec2(cells - 1u)));
  uvec2 last = uvec2(clamp(ceil(high), vec2(1.0), vec2(cells)));
  if (is_mirrored(p.level)) first.y = 0u;
  atomicMax(bounds_found[kind], cells.x - first.x);
  atomicMax(bounds_found[kind + 1u], cells.y - first.y);
  atomicMax(bounds_found[kind + 2u], last.x);
  atomicMax(bounds_found[kind + 3u], last.y);
}

// Looks for light between the rays of a workgroup, and reports where. cell: of the box, of the invocation; reach: of what
// a scan reports, cells on each side. Grids and scans share the code, since processors would execute both.
void inspect(uint item, RaySet rays, vec2 cell, float reach, uvec2 cells) {
  uint k = gl_LocalInvocationIndex;
  bool is_cell = gl_LocalInvocationID.x < COARSE_CELLS && gl_LocalInvocationID.y < COARSE_CELLS;
  uint next = min(k + 1u, 255u);
  uvec4 v = rays.scans ? uvec4(k, next, next, k) : is_cell ? uvec4(k, k + 1u, k + 17u, k + 16u) : uvec4(k);
  uint crossing_count = crossings_of(item), pattern = item_pattern(item);
  // Each number of the corners is read once: lavapipe reads shared memory slowly.
  vec3 corner[4] = vec3[4](corners[v.x], corners[v.y], corners[v.z], corners[v.w]);
  vec4 height = vec4(corner[0].z, corner[1].z, corner[2].z, corner[3].z);
  bvec4 open = lessThanEqual(height, vec4(0.0)), good = lessThan(height, vec4(0.5 * FAILED));
  bool may_pass = may_pass_rim(height, good), on_line = good.x && (open.x || (good.y && open.y));
  for (uint c = 0u; c < crossing_count; ++c) {
    vec2 q[4] = vec2[4](corner[0].xy, corner[1].xy, corner[2].xy, corner[3].xy);
    if (c > 0u)
      for (int j = 0; j < 4; ++j) q[j] = later_stops[c - 1u][v[j]];
    float radius = stop_radius(pattern, c, crossing_count);
    for (int j = 0; j < 4; ++j) open[j] = open[j] && dot(q[j], q[j]) <= radius * radius;
    may_pass = may_pass && (all(good) ? near_stop(q, radius) : near_stop_beside_failing(q, good, radius));
    vec2 end = good.y ? q[1] : q[0];
    on_line = on_line && distance_to_edge(q[0], end) <= radius + 0.5 * length(end - q[0]);
  }
  if (!(rays.scans ? on_line : is_cell && (any(open) || may_pass))) return;
  float around = any(open) && p.level < 2u ? 1.0 : 0.0;  // light also passes beside the rays that do
  vec2 low = rays.scans ? cell - reach : cell - around, high = rays.scans ? cell + reach : cell + 1.0 + around;
  // Light that the second level's scan finds counts only if the grid of that level finds none.
  bool surely = rays.scans ? p.level != 1u : any(open);
  report(surely ? PASSES : MAY_PASS, low, high, cells);
}

// Small pupils among failing rays lie where the plane of the light and the axis meets the entrance plane: a line that is
// searched finely, as meridian_scan.cpp does, by a number of workgroups. With axial symmetry it begins the half of the box
// that is searched.
RaySet rays_on_meridian(uint item, vec2 side, vec4 searched, uint part, uint parts) {
  if (is_mirrored(p.level)) {
    vec2 step_mm = vec2(searched.z / float(255u * parts), 0.0);
    return RaySet(true, searched.xy + float(255u * part) * step_mm, step_mm, vec2(0.0), item_window(item), side);
  }
  path_item = item;
  vec2 window = item_window(item), meridian = meridian_of(item), start = vec2(start_real(START_X), start_real(START_Y));
  vec2 along = vec2(dot(side, meridian), cross2(side, meridian)), corner = vec2(dot(side, start), cross2(side, start));
  float reach = length(max(abs(corner), abs(corner + window)));
  vec2 step_mm = along * (2.0 * reach / float(255u * parts));
  return RaySet(true, float(255u * part) * step_mm - reach * along - corner, step_mm, vec2(0.0), window, side);
}

// The second level scans the meridian in its box if what the first one found may be smaller than its cells.
bool is_scanned_again(uint group) {
  const uint few_cells = 4u;  // two or three from a scan
  uint first = first_level(group);
  return first != 0u || extent_of(cells_that_pass(number_of_level(group, first)), cells_of_level(first)) <= few_cells;
}

RaySet rays_of_block(vec4 searched, vec2 side, vec2 step_mm, uvec2 first_cell) {
  return RaySet(false, searched.xy + vec2(first_cell) * step_mm, vec2(step_mm.x, 0.0), vec2(0.0, step_mm.y), vec2(0.0),
                side);
}

void main() {
  uvec2 cells = cells_of_level(p.level);
  uint blocks = search_blocks(p.level);
  uint group = linear_group() / blocks, block = linear_group() % blocks;
  if (group >= p.group_count) return;
  bool only_scans = p.level == SCAN_LEVEL;
  uint level = only_scans ? SCAN_LEVEL + max(block + 1u, FINE_SCANS) - FINE_SCANS : p.level;
  bool is_outer = level > SCAN_LEVEL;  // at the first or last wavelength
  uint item = item_of_first_level(group, searches_window(level) ? level : first_level(group));
  if ((is_outer && item == group_word(group, 2u)) || (only_scans && passes_at_level(group, 0u))) return;
  uint number = number_of_level(group, level), k = gl_LocalInvocationIndex;
  vec4 box = searches_window(level) ? vec4(0.0, 0.0, item_window(item)) : box_of_level(group, level);
  if ((only_scans || block == 0u) && k < 4u) found[LEVEL_WORDS * number + k] = floatBitsToUint(box[k]);
  if (!(box.z > 0.0)) return;
  if (!searches_window(level) && level < LAST_LEVEL) {
    vec4 before = box_at(level == 1u ? number_of_level(group, first_level(group)) : number - 1u);
    if (is_mirrored(level - 1u) && !is_mirrored(level)) before = bounds_along_frame(meridian_of(item), before);
    if (box.z * box.w > SHRINK_ENOUGH * before.z * before.w) {  // the search is over
      if (block == 0u && k < 4u) found[LEVEL_WORDS * number + 4u + k] = cells[k & 1u];
      return;
    }
  }
  if (k < 8u) bounds_found[k] = 0u;
  vec4 searched = searched_part(level, box);
  vec2 side = is_mirrored(level) ? meridian_of(item) : vec2(1.0, 0.0);
  vec2 step_mm = searched.zw / vec2(cells);
  uint grid_blocks = cells.x * cells.y / (COARSE_CELLS * COARSE_CELLS), blocks_a_row = cells.x / COARSE_CELLS;
  uvec2 first_cell = COARSE_CELLS * uvec2(block % blocks_a_row, block / blocks_a_row);
  bool scans = only_scans || block >= grid_blocks;
  if (scans && p.level == 1u && !is_scanned_again(group)) return;
  bool is_fine = level == SCAN_LEVEL;
  RaySet rays = scans ? rays_on_meridian(item, side, searched, is_fine ? block : 0u, is_fine ? FINE_SCANS : 1u)
                      : rays_of_block(searched, side, step_mm, first_cell);
  vec2 cell = scans ? (place_of(rays, k) - searched.xy) / step_mm : vec2(first_cell + gl_LocalInvocationID.xy);
  bool all_items = !only_scans && (level >= ALL_ITEMS_LEVEL || (scans && level == 1u));
  uint first = all_items ? group_word(group, 0u) : item, count = all_items ? group_word(group, 1u) : 1u;
  if (k == 0u) atomicAdd(counters[COUNT_SEARCHED], count);
  for (uint each = first; each < first + count; ++each) {
    trace_corners(each, rays);
    barrier();
    inspect(each, rays, cell, is_outer ? OUTER_SCAN_REACH : SCAN_REACH, cells);
    barrier();
  }
  if (k < 8u && bounds_found[k] > 0u) atomicMax(found[LEVEL_WORDS * number + 4u + k], bounds_found[k]);
}
