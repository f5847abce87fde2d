// SPDX-License-Identifier: Apache-2.0
// The state of a cell whose size is that of the ghost's features: unlike state_of(), it does not take a cell for closed
// because all corners lie beyond a curved edge.
#include "near_stop.glsl"
#include "pattern.glsl"

bool may_be_open(float low, float high) { return low <= max(0.0, high - low); }

int cell_state(uvec4 v, uint crossing_count, uint pattern) {
  bool open = true, any = false, any_failed = false;
  vec2 height = vec2(FAILED, -FAILED);
  for (int k = 0; k < 4; ++k) {
    open = open && passes(v[k]);
    if (failed(rays[v[k]])) {
      any_failed = true;
      continue;
    }
    any = true;
    height = vec2(min(height.x, rays[v[k]].w - 1.0), max(height.y, rays[v[k]].w - 1.0));
  }
  if (open) return STATE_OPEN;
  if (!any || !may_be_open(height.x, height.y)) return STATE_CLOSED;
  for (uint c = 0u; c < crossing_count && !any_failed; ++c) {
    vec2 q[4];
    for (int k = 0; k < 4; ++k) q[k] = crossing(v[k], c);
    if (!near_stop(q, stop_radius(pattern, c, crossing_count))) return STATE_CLOSED;
  }
  return STATE_CUT;
}

// The region of a cell of four rays in order at the last crossing.
int region_of_rays(uint pattern, uint a, uint b, uint c, uint d, uint crossing_count) {
  uint last = crossing_count - 1u;
  return region_of(pattern, crossing(a, last), crossing(b, last), crossing(c, last), crossing(d, last));
}

// The state of a cell with a stop pattern: cells where the pattern varies are drawn in parts.
int patterned_state(uvec4 v, uint crossing_count, uint pattern) {
  int how = cell_state(v, crossing_count, pattern);
  if (pattern == 0u || how == STATE_CLOSED) return how;
  for (int k = 0; k < 4; ++k)
    if (failed(rays[v[k]])) return how;
  int region = region_of_rays(pattern, v.x, v.y, v.z, v.w, crossing_count);
  return region == REGION_DARK ? STATE_CLOSED : region == REGION_VARYING ? STATE_CUT : how;
}

// Sets what a cell's polygons have in common.
void set_cell(uvec4 v) {
  vec2 near = failed(rays[v.x]) ? rays[v.z].xy : rays[v.x].xy;
  base = ivec2(clamp(floor(near), vec2(0.0), vec2(p.width, p.height)));
  vec4 box = final_box(group_of(item));
  float cells = float(side - 1u);
  gain = state_gain(item, box.xy + box.zw * (vec2(own % side, own / side) + 0.5) / cells);
  triangle_weight = 0.5 * box.z * box.w / (cells * cells) * item_irradiance(item);
}
