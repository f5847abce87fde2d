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

shared float heights[256];  // relative height - 1, FAILED where a ray fails
shared vec2 stops[MAX_CROSSINGS][256];
shared uint bounds_found[8];  // as found[]

void keep_corner(uint k, vec4 ray, vec2 points[MAX_CROSSINGS]) {
  heights[k] = failed(ray) ? FAILED : ray.w - 1.0;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c)
    if (c < crossings_of(path_item)) stops[c][k] = points[c];
}

// Traces the rays of a workgroup: that of each invocation, which enters at a place. later: the place of the invocation
// that comes 128 later. On processors half of the invocations trace two rays each, as a ray waits for its roots and
// divisions most of the time.
void trace_corner(uint item, vec2 at, vec2 later, uint k) {
  set_path(item);
  if (!ON_PROCESSOR) {
    keep_corner(k, trace_ray(at.x, at.y), stop_points);
    return;
  }
  if (k >= 128u) return;
  vec2 other_points[MAX_CROSSINGS] = vec2[MAX_CROSSINGS](vec2(0.0), vec2(0.0), vec2(0.0));
  PacketState s = enter(at.x, at.y), other = enter(later.x, later.y);
  for (uint step = 0u; step < path_steps; ++step) {
    advance(s, step, stop_points);
    advance(other, step, other_points);
  }
  keep_corner(k, land(s), stop_points);
  keep_corner(k + 128u, land(other), other_points);
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

// Reports light within bounds, in cells of the box.
void report(uint kind, vec2 low, vec2 high, uint cells) {
  uvec2 first = uvec2(clamp(floor(low), vec2(0.0), vec2(cells - 1u))), last = uvec2(clamp(ceil(high), vec2(1.0), vec2(cells)));
  atomicMax(bounds_found[kind], cells - first.x);
  atomicMax(bounds_found[kind + 1u], cells - first.y);
  atomicMax(bounds_found[kind + 2u], last.x);
  atomicMax(bounds_found[kind + 3u], last.y);
}

void search_block(uint item, vec4 box, uint cells, uint block) {
  uint k = gl_LocalInvocationIndex, blocks_a_side = cells / COARSE_CELLS;
  uvec2 place = COARSE_CELLS * uvec2(block % blocks_a_side, block / blocks_a_side) + gl_LocalInvocationID.xy;
  trace_corner(item, box.xy + box.zw * vec2(place) / float(cells),
               box.xy + box.zw * vec2(place + uvec2(0u, 8u)) / float(cells), k);
  barrier();
  if (gl_LocalInvocationID.x >= COARSE_CELLS || gl_LocalInvocationID.y >= COARSE_CELLS) return;
  uvec4 v = uvec4(k, k + 1u, k + 17u, k + 16u);
  uint crossing_count = crossings_of(item), pattern = item_pattern(item);
  // Each number of the corners is read once: lavapipe reads shared memory slowly.
  vec4 height = vec4(heights[v.x], heights[v.y], heights[v.z], heights[v.w]);
  bvec4 open = lessThanEqual(height, vec4(0.0)), good = lessThan(height, vec4(0.5 * FAILED));
  bool may_pass = may_pass_rim(height, good);
  for (uint c = 0u; c < crossing_count; ++c) {
    vec2 q[4] = vec2[4](stops[c][v.x], stops[c][v.y], stops[c][v.z], stops[c][v.w]);
    float radius = stop_radius(pattern, c, crossing_count);
    for (int j = 0; j < 4; ++j) open[j] = open[j] && dot(q[j], q[j]) <= radius * radius;
    may_pass = may_pass && (all(good) ? near_stop(q, radius) : near_stop_beside_failing(q, good, radius));
  }
  if (!any(open) && !may_pass) return;
  float around = any(open) && p.level < 2u ? 1.0 : 0.0;  // light also passes beside the rays that do
  report(any(open) ? PASSES : MAY_PASS, vec2(place) - around, vec2(place) + 1.0 + around, cells);
}

// Small pupils among failing rays lie where the plane of the light and the axis meets the entrance plane: a line that is
// searched finely, as meridian_scan.cpp does, by a number of workgroups. reach: of what is reported, cells on each side
// of a hit.
void scan_meridian(uint item, vec4 box, uint cells, uint part, uint parts, float reach_cells) {
  uint k = gl_LocalInvocationIndex;
  path_item = item;
  vec2 along = vec2(start_real(START_STEP_X), start_real(START_STEP_Y)), first = vec2(start_real(START_X), start_real(START_Y));
  float reach = length(max(abs(first), abs(first + box.zw)));
  float step_mm = 2.0 * reach / float(255u * parts);
  vec2 at = along * (float(255u * part + k) * step_mm - reach) - first;
  vec2 later = along * (float(255u * part + k + 128u) * step_mm - reach) - first;
  bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, box.zw));
  trace_corner(item, at, later, k);
  barrier();
  if (!inside) heights[k] = FAILED;
  barrier();
  uint next = min(k + 1u, 255u);
  if (heights[k] >= 0.5 * FAILED) return;
  if (heights[next] >= 0.5 * FAILED) next = k;
  if (min(heights[k], heights[next]) > 0.0) return;
  for (uint c = 0u; c < crossings_of(item); ++c) {
    vec2 a = stops[c][k], b = stops[c][next];
    if (distance_to_edge(a, b) > stop_radius(item_pattern(item), c, crossings_of(item)) + 0.5 * length(b - a)) return;
  }
  vec2 cell = at / box.zw * float(cells);
  report(PASSES, cell - reach_cells, cell + reach_cells, cells);
}

void main() {
  uint cells = cells_of_level(p.level), blocks = search_blocks(p.level);
  uint group = linear_group() / blocks, block = linear_group() % blocks;
  if (group >= p.group_count) return;
  bool is_outer = p.level == OUTER_LEVEL;
  uint level = is_outer ? OUTER_LEVEL + block / OUTER_SCANS : p.level;
  uint item = item_of_first_level(group, searches_window(level) ? level : first_level(group));
  if (is_outer && (item == group_word(group, 2u) || passes_at_level(group, 0u))) return;
  uint at_level = group * LEVELS + level, k = gl_LocalInvocationIndex;
  vec4 box = searches_window(level) ? vec4(0.0, 0.0, item_window(item)) : box_of_level(group, level);
  if (block % (is_outer ? OUTER_SCANS : blocks) == 0u && k == 0u) boxes[at_level] = box;
  if (!(box.z > 0.0)) return;
  if (!searches_window(level) && level < LAST_LEVEL) {
    vec4 before = boxes[level == 1u ? group * LEVELS + first_level(group) : at_level - 1u];
    if (box.z * box.w > SHRINK_ENOUGH * before.z * before.w) {  // the search is over
      if (block == 0u && k < 4u) found[8u * at_level + k] = cells;
      return;
    }
  }
  if (k < 8u) bounds_found[k] = 0u;
  uint grid_blocks = cells * cells / (COARSE_CELLS * COARSE_CELLS);
  if (is_outer) {
    scan_meridian(item, box, cells, block % OUTER_SCANS, OUTER_SCANS, OUTER_SCAN_REACH);
  } else if (block >= grid_blocks) {
    scan_meridian(item, box, cells, block - grid_blocks, SCANS, SCAN_REACH);
  } else if (level < ALL_ITEMS_LEVEL) {
    search_block(item, box, cells, block);
  } else {
    uint first = group_word(group, 0u), end = first + group_word(group, 1u);
    for (uint each = first; each < end; ++each) {
      search_block(each, box, cells, block);
      barrier();
    }
  }
  barrier();
  if (k < 8u && bounds_found[k] > 0u) atomicMax(found[8u * at_level + k], bounds_found[k]);
}
