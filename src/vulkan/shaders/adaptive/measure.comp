// SPDX-License-Identifier: Apache-2.0
// Measures the items of a group, one group a workgroup, from 16 x 16 rays each: how far a grid of this many cells would be
// off, whether another wavelength may serve, and how large a part of the frame has which level, for the frame's peak.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 16, local_size_y = 16) in;
#include "common.glsl"
#include "item_path.glsl"
#include "../iris.glsl"

#define BOUND_LARGEST_DENSITY_CHANGE 2.0

shared vec2 places[256];        // pixels
shared vec2 middle_places[256]; // of the group's middle item
shared vec2 passing[256];       // transmission, -1 where the ray fails; as blocked()
shared float densities[256];    // of cells, with the sign of their area; 0: none
shared vec4 sums_of[256];
shared uint histogram[BINS];

void sum_up() {
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (gl_LocalInvocationIndex < half_count)
      sums_of[gl_LocalInvocationIndex] += sums_of[gl_LocalInvocationIndex + half_count];
    barrier();
  }
}

void largest() {
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (gl_LocalInvocationIndex < half_count)
      sums_of[gl_LocalInvocationIndex] =
          max(sums_of[gl_LocalInvocationIndex], sums_of[gl_LocalInvocationIndex + half_count]);
    barrier();
  }
}

struct Cell {
  bool is_drawn;
  float area_px, length_px, open;  // length: of the longer side, about; open: the part that is open
  float flux, density;  // if it were open, without gain; density: by pixel
};

// The part of a cell in which a function is negative, from its values at the corners, as if its slope were along a side:
// coarse, but smooth, so that wavelengths can be compared.
float open_part(vec4 at) {
  vec2 slope = 0.5 * vec2(at.y - at.x + at.z - at.w, at.w - at.x + at.z - at.y);
  float mean = 0.25 * (at.x + at.y + at.z + at.w);
  return clamp(0.5 - mean / max(abs(slope.x) + abs(slope.y), 1e-12), 0.0, 1.0);
}

Cell cell_at(uint k, float flux_a_transmission) {
  Cell cell = Cell(false, 0.0, 0.0, 0.0, 0.0, 0.0);
  if (gl_LocalInvocationID.x >= COARSE_CELLS || gl_LocalInvocationID.y >= COARSE_CELLS) return cell;
  uvec4 v = uvec4(k, k + 1u, k + 17u, k + 16u);
  float transmission = 0.0;
  for (int j = 0; j < 4; ++j) {
    if (passing[v[j]].x < 0.0) return cell;
    transmission += 0.25 * passing[v[j]].x;
  }
  cell.open = open_part(vec4(passing[v.x].y, passing[v.y].y, passing[v.z].y, passing[v.w].y));
  cell.area_px = 0.5 * cross2(places[v.z] - places[v.x], places[v.w] - places[v.y]);
  cell.length_px = 0.7 * max(length(places[v.z] - places[v.x]), length(places[v.w] - places[v.y]));
  cell.flux = transmission * flux_a_transmission;
  cell.density = cell.flux / max(abs(cell.area_px), 1.0);
  vec2 low = min(min(places[v.x], places[v.y]), min(places[v.z], places[v.w]));
  vec2 high = max(max(places[v.x], places[v.y]), max(places[v.z], places[v.w]));
  vec2 reach = 0.5 * (high - low) + 1.0;
  cell.is_drawn = cell.open > 0.0 && all(lessThan(low - reach, vec2(p.width, p.height))) &&
                  all(greaterThan(high + reach, vec2(0.0)));
  return cell;
}

vec2 second_difference(uint k, uint step_by) {
  if (passing[k - step_by].x < 0.0 || passing[k].x < 0.0 || passing[k + step_by].x < 0.0) return vec2(1.0);
  return places[k - step_by] - 2.0 * places[k] + places[k + step_by];
}

// The mean over the cell of the squared distance of a straight edge from what it stands for.
float squared_sag() {
  uvec2 at = clamp(gl_LocalInvocationID.xy, uvec2(1u), uvec2(14u));
  uint k = 16u * at.y + at.x;
  vec2 x = second_difference(k, 1u), y = second_difference(k, 16u);
  return (dot(x, x) + dot(y, y)) / 64.0;
}

// The squared part of a cell's density by which a linear function is off.
float squared_bend(uint k) {
  float sum = 0.0;
  for (uint axis = 0u; axis < 2u; ++axis) {
    uint step_by = axis == 0u ? 1u : 16u, at = axis == 0u ? gl_LocalInvocationID.x : gl_LocalInvocationID.y;
    if (at == 0u || at + 1u >= COARSE_CELLS) continue;
    float before = densities[k - step_by], here = densities[k], after = densities[k + step_by];
    if (before == 0.0 || after == 0.0) continue;
    float change = (before - 2.0 * here + after) / here;
    if (before * here < 0.0 || after * here < 0.0) change = BOUND_LARGEST_DENSITY_CHANGE;
    change = clamp(change, -BOUND_LARGEST_DENSITY_CHANGE, BOUND_LARGEST_DENSITY_CHANGE);
    sum += change * change / 64.0;
  }
  return sum;
}

// The part of a cell's bounds that lies in the frame.
float part_in_frame(uint k) {
  uvec4 v = uvec4(k, k + 1u, k + 17u, k + 16u);
  vec2 low = min(min(places[v.x], places[v.y]), min(places[v.z], places[v.w]));
  vec2 high = max(max(places[v.x], places[v.y]), max(places[v.z], places[v.w]));
  vec2 inside = clamp(min(high, vec2(p.width, p.height)) - max(low, vec2(0.0)), vec2(0.0), high - low);
  vec2 part = inside / max(high - low, vec2(1e-6));
  return part.x * part.y;
}

// Overlapping ghosts count one by one: the peak is not overestimated. A bin that has as much as is wanted need not be
// exact, here and in publish_histogram(), so that none overflows.
void add_to_histogram(float area_px, Cell cell, vec3 gain) {
  uint wanted = wanted_parts();
  uint counted = uint(min(area_px * PIXEL_PARTS, float(wanted)) + 0.5);
  if (counted == 0u) return;
  for (uint c = 0u; c < 3u; ++c) {
    float value = cell.density * gain[c];
    uint bin = floatBitsToUint(value) >> BIN_SHIFT;
    if (value > 0.0 && histogram[bin] < wanted) atomicAdd(histogram[bin], counted);
  }
}

void publish_histogram() {
  barrier();
  uint wanted = wanted_parts();
  for (uint bin = gl_LocalInvocationIndex; bin < BINS; bin += 256u) {
    if (histogram[bin] != 0u && sums[bin] < wanted) atomicAdd(sums[bin], min(histogram[bin], wanted));
  }
}

float middle_density = 0.0;  // of the cell, in the group's middle item

void trace_corner(uint item, bool is_middle, vec4 box) {
  uint k = gl_LocalInvocationIndex;
  set_path(item);
  vec2 at = box.xy + box.zw * vec2(gl_LocalInvocationID.xy) / float(COARSE_CELLS);
  vec4 ray = trace_ray(at.x, at.y);
  float most = ray.w - 1.0;
  for (uint c = 0u; c < crossings_of(item); ++c) most = max(most, iris_distance(stop_points[c]));
  places[k] = ray.xy;
  if (is_middle) middle_places[k] = ray.xy;
  passing[k] = vec2(failed(ray) ? -1.0 : ray.z, most);
  barrier();
}

// Squared errors, in values of the item; flux and area within the frame. Merged: where edges lie elsewhere.
vec4 sum_errors(Cell cell, float value, float inside_frame) {
  uint k = gl_LocalInvocationIndex;
  vec2 moved = places[k] - middle_places[k];
  float area = max(abs(cell.area_px), 1.0), moved_squared = dot(moved, moved);
  bool is_edge = cell.open < 1.0;
  float inside = area * cell.open * squared_bend(k), edge = is_edge ? cell.length_px * squared_sag() : 0.0;
  float merged = is_edge ? cell.length_px * min(moved_squared, sqrt(moved_squared)) : 0.0;
  sums_of[k] = !cell.is_drawn ? vec4(0.0)
                              : inside_frame * vec4(value * value * (inside + edge), value * value * merged,
                                                    cell.flux * cell.open, area * cell.open);
  sum_up();
  vec4 all = sums_of[0];
  barrier();
  return all;
}

// The mean squared displacement from the middle item, and the squared error where the density's ratio to the middle item's
// is not that of the fluxes: ghosts change their colour from one side to the other.
vec2 compare_with_middle(Cell cell, float value, float inside_frame) {
  uint k = gl_LocalInvocationIndex;
  vec2 moved = places[k] - middle_places[k];
  float scale = value / max(cell.density, 1e-37), weight = max(abs(cell.area_px), 1.0) * cell.open * inside_frame;
  float here = cell.density * scale, there = middle_density * scale;
  bool counts = cell.is_drawn && cell.density > 0.0;
  sums_of[k] = !counts ? vec4(0.0) : weight * vec4(there * there, here * there, here * here, 0.0);
  sum_up();
  vec3 products = sums_of[0].xyz;
  barrier();
  sums_of[k] = !counts ? vec4(0.0) : vec4(dot(moved, moved) * cell.open, cell.open, 0.0, 0.0);
  sum_up();
  vec2 displacement = sums_of[0].xy;
  barrier();
  float error = products.x > 0.0 ? products.z - products.y * products.y / products.x : products.z;
  return vec2(displacement.x / max(displacement.y, 1e-30), max(error, 0.0));
}

float find_extent(Cell cell) {
  uint k = gl_LocalInvocationIndex;
  vec2 reach = vec2(p.width, p.height);
  vec2 at_frame = clamp(places[k], -reach, 2.0 * reach);
  sums_of[k] = cell.is_drawn ? vec4(-at_frame, at_frame) : vec4(-FAILED);
  largest();
  vec2 extent = sums_of[0].zw + sums_of[0].xy;
  return max(max(extent.x, extent.y), 0.0);
}

void measure(uint item, bool is_middle, vec4 box) {
  uint k = gl_LocalInvocationIndex;
  trace_corner(item, is_middle, box);
  float cell_mm2 = box.z * box.w / float(COARSE_CELLS * COARSE_CELLS);
  Cell cell = cell_at(k, cell_mm2 * item_irradiance(item));
  densities[k] = cell.area_px < 0.0 ? -cell.density : cell.density;
  if (is_middle) middle_density = cell.density;
  barrier();
  vec3 gain = item_gain(item);
  float value = cell.density * sqrt(dot(gain, gain) / 3.0);
  float inside_frame = cell.is_drawn ? part_in_frame(k) : 0.0;
  if (cell.is_drawn) add_to_histogram(abs(cell.area_px) * cell.open * inside_frame, cell, gain);
  vec4 all = sum_errors(cell, value, inside_frame);
  vec2 other = compare_with_middle(cell, value, inside_frame);
  float extent = find_extent(cell);
  if (k != 0u) return;
  uint word = STATE_WORDS * item;
  states[word + STATE_ERROR] = all.x;
  states[word + STATE_MERGED_ERROR] = all.y + other.y;
  states[word + STATE_FLUX] = all.z;
  states[word + STATE_DISPLACEMENT] = other.x / max(all.w, 1e-30);
  states[word + STATE_EXTENT] = extent;
}

void main() {
  uint group = linear_group();
  if (group >= p.group_count) return;
  vec4 box = final_box(group);
  uint first = group_word(group, 0u), count = group_word(group, 1u), middle = group_word(group, 2u);
  for (uint bin = gl_LocalInvocationIndex; bin < BINS; bin += 256u) histogram[bin] = 0u;
  barrier();
  if (!(box.z > 0.0)) {
    for (uint k = gl_LocalInvocationIndex; k < count * STATE_WORDS; k += 256u) states[STATE_WORDS * first + k] = 0.0;
    return;
  }
  for (uint turn = 0u; turn < count; ++turn) {
    // The middle item first, which the others are compared with.
    uint item = turn == 0u ? middle : first + turn - (first + turn <= middle ? 1u : 0u);
    measure(item, turn == 0u, box);
    barrier();
  }
  publish_histogram();
}
