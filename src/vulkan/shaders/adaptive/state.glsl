// SPDX-License-Identifier: Apache-2.0
// The state of a cell whose size is that of the ghost's features: unlike state_of(), it does not take a cell for closed
// because all corners lie beyond a curved edge.
#include "near_stop.glsl"
#include "../stop/pattern.glsl"
#ifdef OCCLUDERS
#include "../start.glsl"
#include "item_start.glsl"
#include "front.glsl"
#include "../stop/occluders.glsl"
#endif

bool may_be_open(float low, float high) { return low <= max(0.0, high - low); }

int cell_state(uvec4 v, uint crossing_count, uint pattern) {
  bool open = true, any = false, any_failed = false;
  vec2 height = vec2(FAILED, -FAILED);
  for (int k = 0; k < 4; ++k) {
    open = open && passes(v[k]);
    if (failed(ray_of(v[k]))) {
      any_failed = true;
      continue;
    }
    any = true;
    height = vec2(min(height.x, ray_of(v[k]).w - 1.0), max(height.y, ray_of(v[k]).w - 1.0));
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

#ifdef OCCLUDERS
vec4 grid_box;  // of the item's rays

// A place in the window, from one in the grid.
vec2 entrance_at(vec2 place) { return grid_box.xy + grid_box.zw * (place / float(side - 1u)); }

vec2 point_of_ray(uint ray, uint k) {
  if (k != POINT_FRONT) return crossing(ray, k);
  uint in_grid = ray - first_ray;
  return front_point(item, entrance_at(vec2(in_grid % side, in_grid / side)));
}

// The extent of a pixel's image, from the sides of a cell in pixels and in its image: pixels at the cell's edge see as
// far beyond it. A cell smaller than a pixel does not show what it is.
float pixel_extent_of(vec2 across, vec2 down, vec2 seen_across, vec2 seen_down) {
  float most = length(seen_across) + length(seen_down), det = cross2(across, down);
  vec2 x = seen_across * down.y - seen_down * across.y, y = seen_down * across.x - seen_across * down.x;
  float extent = length(x) + length(y);
  return extent < most * abs(det) ? extent / abs(det) : most;
}

// Whether dirt may dim the cell of four rays in order.
bool is_dirty(uint a, uint b, uint c, uint d, uint crossing_count) {
  vec2 across = 0.5 * (ray_of(b).xy - ray_of(a).xy + ray_of(c).xy - ray_of(d).xy);
  vec2 down = 0.5 * (ray_of(d).xy - ray_of(a).xy + ray_of(c).xy - ray_of(b).xy);
  for (uint k = 0u; k < POINTS; ++k) {
    if (!has_dirt_at(k, crossing_count)) continue;
    vec2 qa = point_of_ray(a, k), qb = point_of_ray(b, k), qc = point_of_ray(c, k), qd = point_of_ray(d, k);
    float pixel_extent = pixel_extent_of(across, down, 0.5 * (qb - qa + qc - qd), 0.5 * (qd - qa + qc - qb));
    if (is_dirty(disc_of(qa, qb, qc, qd, pixel_extent))) return true;
  }
  return false;
}

// Says whether a picture as the iris is dark, uniform or varying over the cell of four rays in order: dark if it is dark
// at one crossing, else uniform if it is at all of them. A stop pattern has a region of its own.
int region_of_picture(uint a, uint b, uint c, uint d, uint crossing_count) {
  int all = REGION_UNIFORM;
  if (!HAS_PICTURE) return all;
  vec2 across = 0.5 * (ray_of(b).xy - ray_of(a).xy + ray_of(c).xy - ray_of(d).xy);
  vec2 down = 0.5 * (ray_of(d).xy - ray_of(a).xy + ray_of(c).xy - ray_of(b).xy);
  uint sharp = pattern_of(item) == 0u ? crossing_count : crossing_count - 1u;
  for (uint k = 0u; k < sharp; ++k) {
    vec2 qa = crossing(a, k), qb = crossing(b, k), qc = crossing(c, k), qd = crossing(d, k);
    float pixel_extent = pixel_extent_of(across, down, 0.5 * (qb - qa + qc - qd), 0.5 * (qd - qa + qc - qb));
    int region = region_of_picture(disc_of(qa, qb, qc, qd, pixel_extent));
    if (region == REGION_DARK) return REGION_DARK;
    if (region == REGION_VARYING) all = REGION_VARYING;
  }
  return all;
}
#endif

// The state of a cell with a stop pattern: cells where the pattern varies are drawn in parts.
int patterned_state(uvec4 v, uint crossing_count, uint pattern) {
  int how = cell_state(v, crossing_count, pattern);
  if (pattern == 0u || how == STATE_CLOSED) return how;
  for (int k = 0; k < 4; ++k)
    if (failed(ray_of(v[k]))) return how;
  int region = region_of_rays(pattern, v.x, v.y, v.z, v.w, crossing_count);
  return region == REGION_DARK ? STATE_CLOSED : region == REGION_VARYING ? STATE_CUT : how;
}

// Sets what a cell's polygons have in common.
void set_block(uvec4 v, uint of_cells) {
  vec2 near = failed(ray_of(v.x)) ? ray_of(v.z).xy : ray_of(v.x).xy;
  base = ivec2(clamp(floor(near), vec2(0.0), vec2(p.width, p.height)));
  vec4 box = state_box(item);
  float cells = float(side - 1u);
  gain = state_gain(item, box.xy + box.zw * (vec2(own % side, own / side) + 0.5 * float(of_cells)) / cells);
  triangle_weight = 0.5 * box.z * box.w / (cells * cells) * item_irradiance(item);
}

void set_cell(uvec4 v) { set_block(v, 1u); }
