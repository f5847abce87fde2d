// SPDX-License-Identifier: Apache-2.0
// Lists the polygons of a part of a cell that is cut by rims or the iris, or is not smooth, one invocation a part. Edges of
// ghosts are finer than the grid: the corners of parts lie between the rays.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#define QUADRILATERALS
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "../polygon.glsl"
#include "../cell.glsl"
#include "list.glsl"
#ifdef OCCLUDERS
#include "../coverage.glsl"
#endif
#include "state.glsl"
#include "between.glsl"

// A triangle or quadrilateral is drawn, as polygon.glsl describes them.
vec2 pixels[3];
vec2 twist = vec2(0.0);
float area_px;           // of the whole
float transmission;      // its mean, or twice that of a quadrilateral

// The stop points of the corners at the last crossing, where the item has a stop pattern.
uint pattern = 0u;
vec2 last_stops[3];
bool is_dimmed = false;  // the triangle, by more than rims and the sharp iris
#ifdef OCCLUDERS
// Shadows are sharper than most fringes, so that all triangles in a pixel must have the mean over the pixel, or each of
// them the mean over itself, where a pixel sees much of the stop.
#define LARGE_PX 0.001
#define LARGE_OF_WIDE_PX 1.0
#define WIDE 0.1
float least_thickness(float longest) { return min(0.1 * longest, 1.0); }  // px
#else
#define LARGE_PX 1.0           // smaller triangles have the mean transmittance of their part of the stop
#define LARGE_OF_WIDE_PX 2.0   // the same where a pixel is WIDE of the stop
#define WIDE 0.5               // stop radii
float least_thickness(float longest) { return 1.0; }  // px
#endif

vec2 middle_of_part;  // in (u, v)
float part_of_triangle;

void find_middle(float fraction) {
  part_of_triangle = fraction;
  middle_of_part = vec2(0.0);
  for (int k = 0; k < corner_count; ++k) middle_of_part += polygon[k];
  middle_of_part /= float(corner_count);
}

// The parallelogram of about the same variances as the clipped triangle, about its middle.
struct Parallelogram {
  vec2 at, x, y;
};

Parallelogram about_triangle(vec2 corners[3]) {
  vec2 u = corners[1] - corners[0], v = corners[2] - corners[0];
  float size = sqrt(part_of_triangle);
  return Parallelogram(corners[0] + u * middle_of_part.x + v * middle_of_part.y, 0.70710678 * size * (u - v),
                       0.40824829 * size * (u + v));
}

// Whether pixels look up transmittances in a triangle; width: of the stop that a pixel sees.
bool is_looked_up(float area, float width) { return area >= (width > WIDE ? LARGE_OF_WIDE_PX : LARGE_PX); }

vec2 to_u, to_v;  // by pixels: the slopes of the triangle's coordinates

// A thin triangle counts as thicker, so that maps do not become steep beside it.
void set_slopes() {
  vec2 a = pixels[1] - pixels[0], b = pixels[2] - pixels[0];
  float longest = max(max(length(a), length(b)), length(a - b)), thickness = 2.0 * area_px / longest;
  float least = least_thickness(longest);
  float extra = thickness < least ? least * least - thickness * thickness : 0.0;
  float aa = dot(a, a) + extra, bb = dot(b, b) + extra, ab = dot(a, b), scale = 1.0 / (aa * bb - ab * ab);
  to_u = (a * bb - b * ab) * scale;
  to_v = (b * aa - a * ab) * scale;
}

// The linear map from pixels to points that are given at the triangle's corners.
struct PointMap {
  vec2 x, y, origin;
};

PointMap map_to(vec2 at[3]) {
  vec2 u = at[1] - at[0], v = at[2] - at[0];
  vec2 middle = (pixels[0] + pixels[1] + pixels[2]) * (1.0 / 3.0);
  vec2 point = (at[0] + at[1] + at[2]) * (1.0 / 3.0);
  PointMap map;
  map.x = u * to_u.x + v * to_v.x;
  map.y = u * to_u.y + v * to_v.y;
  map.origin = point - map.x * middle.x - map.y * middle.y;
  return map;
}

// The edges that have fringes in the triangle.
uint edges_of(PointMap map) {
  vec2 at = (last_stops[0] + last_stops[1] + last_stops[2]) * (1.0 / 3.0);
  float radius = 0.0;
  for (int k = 0; k < 3; ++k) radius = max(radius, length(last_stops[k] - at));
  radius += length(map.x) + length(map.y);  // pixels reach beyond the triangle
  return active_edges(pattern, at, radius);
}

// The width of the stop, or of another plane, that a pixel sees.
float width_of(vec2 at[3]) {
  return sqrt(0.5 * abs(cross2(at[1] - at[0], at[2] - at[0])) / max(area_px, 1e-12));
}

#ifdef OCCLUDERS
#include "cut_occluders.glsl"
#else
// The mean transmittance over the clipped triangle.
float mean_transmittance() {
  Parallelogram mean = about_triangle(last_stops);
  return transmittance_at(pattern, mean.at, mean.x, mean.y, ALL_EDGES);
}

// Sets the map from pixels to stop points. Returns false where the triangle is too small to have one.
bool set_pattern_map() {
  if (!is_looked_up(area_px, width_of(last_stops))) return false;
  set_slopes();
  PointMap map = map_to(last_stops);
  uint edge_bits = edges_of(map);
  record_pattern = edge_bits == 0u ? 0u : pattern;
  pattern_map[0] = map.x;
  pattern_map[1] = map.y;
  pattern_map[2] = map.origin;
  pattern_map[3] = vec2(uintBitsToFloat(edge_bits), 0.0);
  return true;
}

void find_occluders() { is_dimmed = pattern != 0u; }
#endif

// low, high: the polygon's bounds.
void list_part(float flux, float fraction, vec2 gradient, vec2 low, vec2 high) {
  bool is_point = floor(low) == floor(high);
  vec2 from = low, to = low;
  // The corners are compared in pairs only if the polygon is thin for its bounds.
  if (area_px < SLIVER * dot(high - low, high - low)) farthest_corners(from, to);
  bool is_line = area_px < SLIVER * dot(to - from, to - from);
#ifdef OCCLUDERS
  if (is_dimmed) flux *= set_occluders(is_point, is_line);
#else
  if (is_dimmed && (is_point || is_line || !set_pattern_map())) flux *= mean_transmittance();
#endif
  bool is_small = is_point || is_line;
  float value = is_small ? flux * fraction : flux / area_px;
  vec2 middle = is_quad ? 0.5 * (pixels[1] + pixels[2]) + 0.25 * twist
                        : (pixels[0] + pixels[1] + pixels[2]) * (1.0 / 3.0);
  if (is_small) middle = vec2(0.0);
  list_any(is_point, is_line, from, to, Density(middle, value, is_small ? vec2(0.0) : gradient * value), low, high);
}

void list_triangle(vec2 gradient) {
  begin_triangle();
  clip_triangle(HAS_PICTURE ? 0u : pattern == 0u ? crossings_of(item) : crossings_of(item) - 1u);
  if (corner_count < 3) return;
  float fraction = (is_quad ? 0.5 : 1.0) * abs(twice_polygon_area());  // the triangle's area is 1/2
  find_occluders();
  if (is_dimmed) {
    for (int k = 0; k < 3; ++k) last_stops[k] = stops_of_triangle[crossings_of(item) - 1u][k];
    find_middle(fraction);
  }
  vec2 low = vec2(FAILED), high = vec2(-FAILED);
  for (int k = 0; k < corner_count; ++k) {
    vec2 at = polygon[k];
    at = pixels[0] + (pixels[1] - pixels[0]) * at.x + (pixels[2] - pixels[0]) * at.y + twist * (at.x * at.y);
    polygon[k] = at;
    low = min(low, at);
    high = max(high, at);
  }
  list_part(triangle_weight * transmission, fraction, gradient, low, high);
}

// The corners of the part, in order; stops: where their rays cross the stop.
struct Part {
  vec2 pixels[4], stops[MAX_CROSSINGS][4];
  vec4 light, heights;
#ifdef OCCLUDERS
  vec2 fronts[4];
#endif
};
Part part;

// A part is drawn whole, or in halves.
#define WHOLE 0u
#define FIRST_HALF 1u
#define SECOND_HALF 2u

// Reads where the corners' rays cross the stop, from their weights: the crossings around are read once for all corners.
void read_stops(float weights_of[4][12]) {
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= crossings_of(item)) continue;
    vec2 sum[4] = vec2[4](vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0));
    for (int j = 0; j < 12; ++j) {
      vec2 at = crossing(around[j], c);
      for (int k = 0; k < 4; ++k) sum[k] += weights_of[k][j] != 0.0 ? weights_of[k][j] * at : vec2(0.0);
    }
    part.stops[c] = sum;
  }
}

// Reads a square part of the cell. Corners of the cell are its rays, of which some may fail. Heights and
// crossings are linear in the part, and bend in truth. They are moved by the mean of that, as is the light, so that
// edges, which are chords, let as much light pass as the curves do.
void read_part(vec2 low, float size) {
  const vec2 corners[4] = vec2[4](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0));
  float weights_of[4][12];
  find_around();
  for (int k = 0; k < 4; ++k) {
    vec2 at = low + size * corners[k];
#ifdef OCCLUDERS
    part.fronts[k] = front_at(at);
#endif
    set_weights(at, !is_on_straight_row(at), !is_on_straight_column(at));
    part.pixels[k] = ray_between().xy - vec2(base);
    set_weights(at, true, true);
    add_mean_bend(at, size);
    vec4 ray = ray_between();
    part.light[k] = max(ray.z, 0.0);
    part.heights[k] = ray.w;
    weights_of[k] = weights;
  }
  read_stops(weights_of);
}

// Values at the corners of what is drawn: the first, second and last one.
vec2[3] drawn_corners(vec2 at[4], uint how) {
  return vec2[3](at[0], how == SECOND_HALF ? at[2] : at[1], how == FIRST_HALF ? at[2] : at[3]);
}
vec2 twist_between(vec2 at[4]) { return at[0] - at[1] + at[2] - at[3]; }

void set_drawn(uint how) {
  vec4 heights = part.heights;
  heights_of_triangle =
      float[3](heights.x, how == SECOND_HALF ? heights.z : heights.y, how == FIRST_HALF ? heights.z : heights.w);
  height_twist = heights.x - heights.y + heights.z - heights.w;
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= crossings_of(item)) continue;
    stops_of_triangle[c] = drawn_corners(part.stops[c], how);
    stop_twists[c] = twist_between(part.stops[c]);
  }
#ifdef OCCLUDERS
  front_of_triangle = drawn_corners(part.fronts, how);
#endif
  is_quad = how == WHOLE;
  vec2 a = part.pixels[0], b = part.pixels[1], c = part.pixels[2], d = part.pixels[3];
  float first_half = (part.light.x + part.light.y + part.light.z) / 3.0;
  float second_half = (part.light.x + part.light.z + part.light.w) / 3.0;
  transmission = (how == SECOND_HALF ? 0.0 : first_half) + (how == FIRST_HALF ? 0.0 : second_half);
  pixels = drawn_corners(part.pixels, how);
  twist = is_quad ? twist_between(part.pixels) : vec2(0.0);
  area_px = 0.5 * abs(is_quad ? cross2(c - a, d - b) : cross2(pixels[1] - a, pixels[2] - a));
}

// Patterns and occluders are linear over triangles, and the light of a quadrilateral that is about to fold is uneven.
#define LEAST_CORNER 0.7  // the area of the parallelogram at a corner of a quadrilateral, by the mean
bool is_drawn_whole() {
#ifdef OCCLUDERS
  return false;
#else
  vec2 a = part.pixels[0], b = part.pixels[1], c = part.pixels[2], d = part.pixels[3];
  vec4 areas = vec4(cross2(b - a, d - a), cross2(c - b, a - b), cross2(d - c, b - c), cross2(a - d, c - d));
  float least = LEAST_CORNER * 0.25 * abs(areas.x + areas.y + areas.z + areas.w);
  return pattern == 0u && (all(greaterThan(areas, vec4(least))) || all(lessThan(areas, vec4(-least))));
#endif
}

void main() {
  uint k = linear_group() * 64u + gl_LocalInvocationID.x;
  if (k >= min(counters[COUNT_CUT], p.cut_capacity)) return;
  uvec2 words = texelFetch(cut_texels, int(k)).xy;
  item = words.x;
  own = words.y & CUT_CELL_MASK;
  uint parts = 1u + (words.y >> CUT_PARTS_SHIFT), number = (words.y >> CUT_PART_SHIFT) & 15u;
  side = cells_of(item) + 1u;
  first_ray = 64u * offset_of(item);
  uvec4 v = first_ray + own + uvec4(0u, 1u, side + 1u, side);
  set_cell(v);
  pattern = pattern_of(item);
#ifdef OCCLUDERS
  grid_box = state_box(item);
#endif
  bvec4 fails = bvec4(failed(ray_of(v.x)), failed(ray_of(v.y)), failed(ray_of(v.z)), failed(ray_of(v.w)));
  if (fails.x || fails.z || fails.y && fails.w) return;
  vec4 e = vec4(irradiance_at(v.x), irradiance_at(v.y), irradiance_at(v.z), irradiance_at(v.w));
  float area = any(fails) ? 0.0 : 0.5 * cross2(ray_of(v.z).xy - ray_of(v.x).xy, ray_of(v.w).xy - ray_of(v.y).xy);
  bool is_shaded = all(greaterThan(e, vec4(0.0))) && abs(area) >= SHADED_CELL_PX;
  vec2 gradient = is_shaded ? gradient_of(v, e) : vec2(0.0);
  float size = 1.0 / float(parts);
  read_part(vec2(number % parts, number / parts) * size, size);
  triangle_weight *= size * size;
  bool has_halves = !any(fails) && !is_drawn_whole();
  uint how = fails.y ? SECOND_HALF : fails.w || has_halves ? FIRST_HALF : WHOLE;
  bool is_last;
  do {
    set_drawn(how);
    list_triangle(gradient);
    is_last = how != FIRST_HALF || !has_halves;
    how = SECOND_HALF;
  } while (!is_last);
}
