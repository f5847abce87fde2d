// SPDX-License-Identifier: Apache-2.0
// Measures the items of a group, one group a workgroup, from 16 x 16 rays each: how far a grid of this many cells would be
// off, whether another wavelength may serve, and how large a part of the frame has which level, for the frame's peak.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
layout(local_size_x = 16, local_size_y = 16) in;
#include "common.glsl"
#include "item_path.glsl"
#include "../iris.glsl"
#include "../stop/pattern.glsl"
#include "group_sums.glsl"
#ifdef OCCLUDERS
#include "../coverage.glsl"
#include "front.glsl"
#include "../stop/occluders.glsl"
#endif

#define BOUND_LARGEST_DENSITY_CHANGE 6.0  // of folds; chosen, so that caustics are as exact as the rest
#define UNKNOWN_SAG_SQUARED (1.0 / 32.0)  // beside rays that fail, pixels
#define TYPICAL_BEND 0.45                 // along an edge, of the sum of all second differences
#define LARGEST_ROUGHNESS 0.5             // the mean squared slope by pixel of a pattern
// The squared distance of two straight lines from a parabola of height 1 for which they stand: with a point between its
// ends that keeps the area (cut_polygon.glsl), and with one on the parabola.
#define SQUARED_WITH_AREA (2.0 / 135.0)
#define SQUARED_ON_CURVE (1.0 / 30.0)
#define SIDES_PART 0.56                   // of the bends of sides that edges show; chosen, not derived

// Values that are read together lie together, and are read once: lavapipe reads each word of shared memory in a loop.
// They lie in the rows in which the sums are made later. Each ray's pixel; its transmission, -1 if it fails; and its
// largest height at a rim.
#define RAY_ROW 0u
// The point farthest outside at which it crosses the stop, and the point's distance from the iris, < 0 inside.
#define STOP_ROW 1u
// The point at which it crosses the stop last, if the item has a stop pattern, and that in the plane of dirt, mm.
#define SEEN_ROW 3u
// A cell's density, with the sign of its area, 0 if there is none; the square of its value, times its area in the frame.
shared vec2 cell_values[256];
shared uint histogram[BINS];

uint crossings_of_group = 0u;
uint pattern = 0u;          // of the item
uint sharp_crossings = 0u;  // where the iris is sharp

// The values of the rays at the corners of the invocation's cell, and of the next ray in the row and in the column:
// before the first corner, or behind the others where there is none.
vec4 corner_rays[4], row_ray, column_ray;
vec3 corner_stops[4], row_stop, column_stop;
bool is_row_before, is_column_before;

struct Cell {
  bool is_drawn;
  bool has_edge;
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

bool is_cell() { return gl_LocalInvocationID.x < COARSE_CELLS && gl_LocalInvocationID.y < COARSE_CELLS; }

// The rays at the corners of the invocation's cell; of invocations without one, some rays.
uvec4 rays_at_corners() {
  uint k = gl_LocalInvocationIndex;
  return is_cell() ? uvec4(k, k + 1u, k + 17u, k + 16u) : uvec4(k);
}

// The ray about which the cell's second differences are taken.
uint ray_inside() {
  uvec2 at = clamp(gl_LocalInvocationID.xy, uvec2(1u), uvec2(14u));
  return 16u * at.y + at.x;
}

vec2 last_stop(uint k) { return rows[SEEN_ROW][k].xy; }
vec2 dirt_point(uint k) { return rows[SEEN_ROW][k].zw; }

void read_rays() {
  uvec4 v = rays_at_corners();
  is_row_before = gl_LocalInvocationID.x > 0u;
  is_column_before = gl_LocalInvocationID.y > 0u;
  uint row = is_row_before ? v.x - 1u : v.x + 2u, column = is_column_before ? v.x - 16u : v.x + 32u;
  for (int j = 0; j < 4; ++j) corner_rays[j] = rows[RAY_ROW][v[j]];
  for (int j = 0; j < 4; ++j) corner_stops[j] = rows[STOP_ROW][v[j]].xyz;
  row_ray = rows[RAY_ROW][row];
  row_stop = rows[STOP_ROW][row].xyz;
  column_ray = rows[RAY_ROW][column];
  column_stop = rows[STOP_ROW][column].xyz;
}

// Second differences, from the values at a cell's first corner, at the next one and at the ray beside them.
vec4 second_difference(vec4 first, vec4 second, vec4 beside, bool is_before) {
  return is_before ? beside - 2.0 * first + second : first - 2.0 * second + beside;
}
vec4 ray_bend_of_row() { return second_difference(corner_rays[0], corner_rays[1], row_ray, is_row_before); }
vec4 ray_bend_of_column() { return second_difference(corner_rays[0], corner_rays[3], column_ray, is_column_before); }
vec2 stop_bend(vec3 second, vec3 beside, bool is_before) {
  return second_difference(vec4(corner_stops[0], 0.0), vec4(second, 0.0), vec4(beside, 0.0), is_before).xy;
}

// As blocked(), at a corner.
float blocked_at(int corner) { return max(corner_rays[corner].w - 1.0, corner_stops[corner].z); }

// The mean transmittance of the item's stop pattern over a cell.
float transmitted_by(uvec4 v) {
  vec2 a = last_stop(v.x), b = last_stop(v.y), c = last_stop(v.z), d = last_stop(v.w);
  return transmittance_at(pattern, 0.25 * (a + b + c + d), 0.5 * (b - a + c - d), 0.5 * (d - a + c - b), ALL_EDGES);
}

vec2 lowest_place() {
  return min(min(corner_rays[0].xy, corner_rays[1].xy), min(corner_rays[2].xy, corner_rays[3].xy));
}
vec2 highest_place() {
  return max(max(corner_rays[0].xy, corner_rays[1].xy), max(corner_rays[2].xy, corner_rays[3].xy));
}

// The invocation's cell.
Cell find_cell(float flux_a_transmission) {
  Cell cell = Cell(false, false, 0.0, 0.0, 0.0, 0.0, 0.0);
  if (!is_cell()) return cell;
  uvec4 v = rays_at_corners();
  float transmission = 0.0;
  for (int j = 0; j < 4; ++j) {
    if (corner_rays[j].z < 0.0) return cell;
    transmission += 0.25 * corner_rays[j].z;
  }
  cell.open = open_part(vec4(blocked_at(0), blocked_at(1), blocked_at(2), blocked_at(3)));
  cell.has_edge = cell.open < 1.0;
  if (pattern != 0u) cell.open *= transmitted_by(v);
#ifdef OCCLUDERS
  if (HAS_PICTURE && pattern == 0u) {
    vec2 a = last_stop(v.x), b = last_stop(v.y), c = last_stop(v.z), d = last_stop(v.w);
    cell.open *= picture_over(0.25 * (a + b + c + d), 0.5 * (b - a + c - d), 0.5 * (d - a + c - b));
  }
#endif
  vec2 down = corner_rays[2].xy - corner_rays[0].xy, up = corner_rays[3].xy - corner_rays[1].xy;  // diagonals
  cell.area_px = 0.5 * cross2(down, up);
  cell.length_px = 0.7 * max(length(down), length(up));
  cell.flux = transmission * flux_a_transmission;
  cell.density = cell.flux / max(abs(cell.area_px), 1.0);
  vec2 low = lowest_place(), high = highest_place(), reach = 0.5 * (high - low) + 1.0;
  cell.is_drawn = cell.open > 0.0 && all(lessThan(low - reach, vec2(p.width, p.height))) &&
                  all(greaterThan(high + reach, vec2(0.0)));
  return cell;
}

bool has_neighbours_in_row() { return min(min(corner_rays[0].z, corner_rays[1].z), row_ray.z) >= 0.0; }
bool has_neighbours_in_column() { return min(min(corner_rays[0].z, corner_rays[3].z), column_ray.z) >= 0.0; }
vec2 bend_of_row() { return ray_bend_of_row().xy; }
vec2 bend_of_column() { return ray_bend_of_column().xy; }

// The squared distances below are means over the cell, of an edge that is drawn from the one that it stands for.
// Straight sides of cells and parts, whose images bend.
float squared_sag_of_sides() {
  vec2 x = has_neighbours_in_row() ? bend_of_row() : vec2(1.0);
  vec2 y = has_neighbours_in_column() ? bend_of_column() : vec2(1.0);
  return SIDES_PART * SQUARED_ON_CURVE * (dot(x, x) + dot(y, y)) / 64.0;
}

vec2 corners_along_row() { return corner_rays[1].xy - corner_rays[0].xy + corner_rays[2].xy - corner_rays[3].xy; }
vec2 corners_along_column() { return corner_rays[3].xy - corner_rays[0].xy + corner_rays[2].xy - corner_rays[1].xy; }

// An edge where a function is 0 that is linear in each part of the grid, with the right mean. x, y: second differences of
// the function; at: its values at the corners.
float squared_edge_sag(vec4 at, float x, float y) {
  vec2 slope = 0.5 * vec2(at.y - at.x + at.z - at.w, at.w - at.x + at.z - at.y);
  float bend = abs(x) + abs(y) + abs(at.x - at.y + at.z - at.w);
  vec2 along_x = 0.5 * corners_along_row(), along_y = 0.5 * corners_along_column();
  float cells = TYPICAL_BEND * bend / 8.0 / max(dot(slope, slope), 1e-12);
  float displaced = min(cells * length(slope.x * along_x + slope.y * along_y), length(along_x) + length(along_y));
  return SQUARED_WITH_AREA * displaced * displaced;
}

bool has_edge(vec4 at) {
  return min(min(at.x, at.y), min(at.z, at.w)) <= 0.0 && max(max(at.x, at.y), max(at.z, at.w)) > 0.0;
}

// The mean squared distance of the edges in a cell from what they stand for.
float squared_sag() {
  if (!has_neighbours_in_row() || !has_neighbours_in_column()) return UNKNOWN_SAG_SQUARED;
  float squared = squared_sag_of_sides();
  vec4 rim = vec4(corner_rays[0].w, corner_rays[1].w, corner_rays[2].w, corner_rays[3].w);
  if (has_edge(rim - 1.0))
    squared += squared_edge_sag(rim, ray_bend_of_row().w, ray_bend_of_column().w);
  vec4 iris = vec4(corner_stops[0].z, corner_stops[1].z, corner_stops[2].z, corner_stops[3].z);
  if (has_edge(iris)) {
    // The iris itself is exact: only what moves its edge along its normal counts.
    vec2 a = corner_stops[0].xy, b = corner_stops[1].xy, c = corner_stops[2].xy, d = corner_stops[3].xy;
    vec2 normal = normalize(a + b + c + d + vec2(1e-20));
    vec2 in_row = stop_bend(corner_stops[1], row_stop, is_row_before);
    vec2 in_column = stop_bend(corner_stops[3], column_stop, is_column_before);
    squared += squared_edge_sag(vec4(dot(normal, a), dot(normal, b), dot(normal, c), dot(normal, d)),
                                dot(normal, in_row), dot(normal, in_column));
  }
  return squared;
}

#include "roughness.glsl"

// The density of the cell some steps from the invocation's; 0: there is none.
float density_at(ivec2 steps) {
  ivec2 at = ivec2(gl_LocalInvocationID.xy) + steps;
  bool exists = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(COARSE_CELLS)));
  return exists ? cell_values[16 * at.y + at.x].x : 0.0;
}

// Densities' relative change across a square of cells: its mixed second difference.
float mixed_change(float here, vec4 along_axes, vec4 diagonal) {
  const vec4 signs = vec4(1.0, -1.0, 1.0, -1.0);  // of the quarters, in order
  vec4 change = (diagonal - along_axes - along_axes.yzwx + here) / here * signs;
  float sum = 0.0, count = 0.0;
  for (int k = 0; k < 4; ++k) {
    if (diagonal[k] == 0.0 || along_axes[k] == 0.0 || along_axes[(k + 1) & 3] == 0.0) continue;
    sum += change[k];
    count += 1.0;
  }
  return sum / max(count, 1.0);
}

// The squared part of a cell's density by which a linear function is off. Beside rays that fail, where densities change
// most, it is taken from two cells on the other side.
#define SQUARED_OF_MIXED 5.0  // of a mixed difference, by that of one along an axis
float squared_bend(uint k) {
  const ivec2 axes[4] = ivec2[4](ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1));
  float sum = 0.0, here = cell_values[k].x;
  vec4 beside, diagonal;
  for (int j = 0; j < 4; ++j) beside[j] = density_at(axes[j]);
  for (int j = 0; j < 4; ++j) diagonal[j] = density_at(axes[j] + axes[(j + 1) & 3]);
  for (int axis = 0; axis < 2; ++axis) {
    float before = beside[axis + 2], after = beside[axis];
    vec3 three = before == 0.0  ? vec3(here, after, density_at(2 * axes[axis]))
                 : after == 0.0 ? vec3(density_at(-2 * axes[axis]), before, here)
                                : vec3(before, here, after);
    if (three.x == 0.0 || three.y == 0.0 || three.z == 0.0) continue;
    float change = (three.x - 2.0 * three.y + three.z) / here;
    if (three.x * here < 0.0 || three.y * here < 0.0 || three.z * here < 0.0) change = BOUND_LARGEST_DENSITY_CHANGE;
    change = clamp(change, -BOUND_LARGEST_DENSITY_CHANGE, BOUND_LARGEST_DENSITY_CHANGE);
    sum += change * change / 64.0;
  }
  if (here == 0.0) return sum;
  float mixed = min(abs(mixed_change(here, beside, diagonal)), BOUND_LARGEST_DENSITY_CHANGE);
  return sum + SQUARED_OF_MIXED * mixed * mixed / 64.0;
}

// The part of squared_bend() that shows: pixels sum what is smaller than they are.
#define LITTLE_SHOWN_PX 1.0  // chosen: small pictures are as exact as large ones
float shown_part(float area_px) {
  float squared = area_px * area_px;
  return squared / (squared + LITTLE_SHOWN_PX * LITTLE_SHOWN_PX);
}

// The part of the cell's bounds that lies in the frame.
float part_in_frame() {
  vec2 low = lowest_place(), high = highest_place();
  vec2 inside = clamp(min(high, vec2(p.width, p.height)) - max(low, vec2(0.0)), vec2(0.0), high - low);
  vec2 part = inside / max(high - low, vec2(1e-6));
  return part.x * part.y;
}

// Squared errors of a cell of which some rays fail and others carry light, which is drawn in part only: as of a cell
// beside it with a quarter of the light.
float squared_light_beside_failing() {
  if (!is_cell()) return 0.0;
  bool any_fails = false, any_open = false;
  for (int j = 0; j < 4; ++j) {
    bool fails = corner_rays[j].z < 0.0;
    any_fails = any_fails || fails;
    any_open = any_open || (!fails && blocked_at(j) <= 0.0);
  }
  if (!any_fails || !any_open) return 0.0;
  uint k = gl_LocalInvocationIndex, x = gl_LocalInvocationID.x, y = gl_LocalInvocationID.y;
  float before_x = x > 0u ? cell_values[k - 1u].y : 0.0, after_x = x + 1u < COARSE_CELLS ? cell_values[k + 1u].y : 0.0;
  float before_y = y > 0u ? cell_values[k - 16u].y : 0.0, after_y = y + 1u < COARSE_CELLS ? cell_values[k + 16u].y : 0.0;
  float largest_error = max(max(before_x, after_x), max(before_y, after_y));
  return 0.25 * largest_error;
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
vec2 middle_place;           // of the ray, in that item

vec2 place_of(vec4 box, uint k) { return box.xy + box.zw * vec2(k & 15u, k >> 4u) / float(COARSE_CELLS); }

// at: where the ray enters; points: where it crosses the stop.
void keep_corner(uint k, uint item, vec2 at, vec4 ray, vec2 points[MAX_CROSSINGS]) {
  vec2 farthest = points[0];
  float distance = sharp_crossings > 0u ? iris_distance(farthest) : -1.0;
  for (uint c = 1u; c < sharp_crossings; ++c) {
    float here = iris_distance(points[c]);
    if (here > distance) farthest = points[c];
    distance = max(distance, here);
  }
  rows[RAY_ROW][k] = vec4(ray.xy, failed(ray) ? -1.0 : ray.z, ray.w);
  rows[STOP_ROW][k] = vec4(farthest, distance, 0.0);
  vec2 last = vec2(0.0), at_dirt = vec2(0.0);
  if (pattern != 0u) last = points[sharp_crossings];
#ifdef OCCLUDERS
  if (HAS_PICTURE) last = points[crossings_of_group - 1u];
  if ((p.flags & FLAG_DIRT_ON_FRONT) != 0u)
    at_dirt = front_point(item, at);
  else if ((p.flags & FLAG_DIRT_IN_STOP) != 0u)
    at_dirt = points[crossings_of_group - 1u] * dirt_float(DIRT_MM_A_UNIT);
#endif
  rows[SEEN_ROW][k] = vec4(last, at_dirt);
}

// Traces the rays of a workgroup, one an invocation; on processors half of the invocations trace two rays each.
void trace_corners(uint item, vec4 box) {
  uint k = gl_LocalInvocationIndex;
  set_path(item);
  vec2 at = place_of(box, k), other_at = place_of(box, k + 128u);
  if (!ON_PROCESSOR) {
    vec4 ray = trace_ray(at.x, at.y);
    keep_corner(k, item, at, ray, stop_points);
  } else if (k < 128u) {
    TwoRays two = trace_two(at, other_at);
    keep_corner(k, item, at, two.first, two.first_points);
    keep_corner(k + 128u, item, other_at, two.second, two.second_points);
  }
  barrier();
}

// Squared errors, in values of the item, between edges; flux and area within the frame. Merged: where edges lie
// elsewhere.
vec4 errors_of(Cell cell, float value, float inside_frame) {
  uint k = gl_LocalInvocationIndex;
  vec2 moved = corner_rays[0].xy - middle_place;
  float area = max(abs(cell.area_px), 1.0), moved_squared = dot(moved, moved);
  float inside = area * cell.open * squared_bend(k) * shown_part(cell.area_px);
  float merged = cell.has_edge ? cell.length_px * min(moved_squared, sqrt(moved_squared)) : 0.0;
  if (pattern != 0u && cell.is_drawn)
    merged += area * (roughness_px(cell) * min(moved_squared, 1.0) + cell.open * pattern_difference(pattern));
#ifdef OCCLUDERS
  if (cell.is_drawn) {
    float rough = dirt_roughness_px(cell), of_picture = picture_roughness_px(cell);
    inside += area * rough * squared_bend_of_map(k, true);
    if (of_picture > 0.0) inside += area * of_picture * squared_bend_of_map(k, false);
    merged += area * (rough + of_picture) * min(moved_squared, 1.0);
  }
#endif
  vec4 errors = !cell.is_drawn ? vec4(0.0)
                               : inside_frame * vec4(value * value * inside, value * value * merged,
                                                     cell.flux * cell.open, area * cell.open);
  errors.x += squared_light_beside_failing();
  return errors;
}

// The squared errors of straight edges, and of drawing a stop pattern as the sharp iris, in values of the item, within
// the frame.
vec2 edge_errors_of(Cell cell, float value, float inside_frame) {
  bool is_edge = cell.is_drawn && cell.has_edge;
  float edge = is_edge ? cell.length_px * squared_sag() : 0.0;
  float sharp = 0.0;
  if (pattern != 0u && cell.is_drawn) {
    float area = max(abs(cell.area_px), 1.0);
    edge += area * roughness_px(cell) * squared_bend_of_map(gl_LocalInvocationIndex, false);
    sharp = area * cell.open * pattern_difference(pattern);
  }
  return inside_frame * value * value * vec2(edge, sharp);
}

bool is_compared(Cell cell) { return cell.is_drawn && cell.density > 0.0; }

// The squared displacement from the middle item, and its weight.
vec2 displacement_of(Cell cell) {
  vec2 moved = corner_rays[0].xy - middle_place;
  return is_compared(cell) ? vec2(dot(moved, moved) * cell.open, cell.open) : vec2(0.0);
}

// Products of the middle item's density, which is first, and the item's own.
vec3 products_of(Cell cell, float value, float inside_frame) {
  float scale = value / max(cell.density, 1e-37), weight = max(abs(cell.area_px), 1.0) * cell.open * inside_frame;
  float here = cell.density * scale, there = middle_density * scale;
  return is_compared(cell) ? weight * vec3(there * there, here * there, here * here) : vec3(0.0);
}

// The squared error where the density's ratio to the middle item's is not that of the fluxes: ghosts change their colour
// from one side to the other.
float error_of_colours(vec3 products) {
  return max(products.x > 0.0 ? products.z - products.y * products.y / products.x : products.z, 0.0);
}

// The first ray of the cell as (-x, -y, x, y), the largest of which bound the image.
vec4 bounds_of(Cell cell) {
  vec2 reach = vec2(p.width, p.height);
  vec2 at_frame = clamp(corner_rays[0].xy, -reach, 2.0 * reach);
  return cell.is_drawn ? vec4(-at_frame, at_frame) : vec4(-FAILED);
}

float extent_of(vec4 bounds) { return max(max(bounds.x + bounds.z, bounds.y + bounds.w), 0.0); }

void measure(uint item, bool is_middle, vec4 box) {
  uint k = gl_LocalInvocationIndex;
  pattern = item_pattern(item);
  sharp_crossings = HAS_PICTURE ? 0u : crossings_of_group - (pattern != 0u ? 1u : 0u);
  trace_corners(item, box);
  read_rays();
  if (is_middle) middle_place = corner_rays[0].xy;
  float cell_mm2 = box.z * box.w / float(COARSE_CELLS * COARSE_CELLS);
  Cell cell = find_cell(cell_mm2 * item_irradiance(item));
  vec3 gain = item_gain(item);
  float mean_gain = sqrt(dot(gain, gain) / 3.0), value = cell.density * mean_gain, area = abs(cell.area_px);
  float inside_frame = part_in_frame();
  cell_values[k] = vec2(cell.area_px < 0.0 ? -cell.density : cell.density,
                        value > 0.0 ? value * value * area * inside_frame : 0.0);
  if (is_middle) middle_density = cell.density;
  barrier();
  if (cell.is_drawn) add_to_histogram(area * cell.open * inside_frame, cell, gain);
  vec4 errors = errors_of(cell, value, inside_frame), bounds = bounds_of(cell);
  vec2 edges = edge_errors_of(cell, value, inside_frame), displacement = displacement_of(cell);
  vec3 products = products_of(cell, value, inside_frame);
  barrier();  // what lies in the rows has been read
  rows[0][k] = errors;
  rows[1][k] = vec4(edges, displacement);
  rows[2][k] = vec4(products, 0.0);
  rows[LARGEST_ROW][k] = bounds;
  sum_rows();
  if (k != 0u) return;
  vec4 all = rows[0][0], others = rows[1][0];
  uint word = STATE_WORDS * item;
  states[word + STATE_ERROR] = all.x;
  states[word + STATE_EDGE_ERROR] = others.x;
  states[word + STATE_SHARP_ERROR] = others.y;
  states[word + STATE_MERGED_ERROR] = all.y + error_of_colours(rows[2][0].xyz);
  states[word + STATE_FLUX] = all.z;
  states[word + STATE_DISPLACEMENT] = others.z / max(others.w, 1e-30) / max(all.w, 1e-30);
  states[word + STATE_EXTENT] = extent_of(rows[LARGEST_ROW][0]);
}

void main() {
  uint group = linear_group();
  if (group >= p.group_count) return;
  vec4 box = final_box(group);
  uint first = group_word(group, 0u), count = group_word(group, 1u), middle = group_word(group, 2u);
  crossings_of_group = crossings_of(first);
  for (uint bin = gl_LocalInvocationIndex; bin < BINS; bin += 256u) histogram[bin] = 0u;
  barrier();
  if (!(box.z > 0.0)) {
    for (uint k = gl_LocalInvocationIndex; k < count * STATE_WORDS; k += 256u) states[STATE_WORDS * first + k] = 0.0;
    return;
  }
  if (gl_LocalInvocationIndex == 0u) atomicAdd(counters[COUNT_SEARCHED], count);
  for (uint turn = 0u; turn < count; ++turn) {
    // The middle item first, which the others are compared with.
    uint item = turn == 0u ? middle : first + turn - (first + turn <= middle ? 1u : 0u);
    measure(item, turn == 0u, box);
    barrier();
  }
  publish_histogram();
}
