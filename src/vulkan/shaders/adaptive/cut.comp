// SPDX-License-Identifier: Apache-2.0
// Lists the polygons of a part of a cell that is cut by rims or the iris, or is not smooth, one invocation a part. Edges
// of ghosts are finer than the grid: the corners of parts lie between the rays, and each edge has a point between its
// ends.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
#define READ_TEXELS
#define QUADRILATERALS
#include "common.glsl"
#include "grid.glsl"
#include "../iris.glsl"
#include "clip_part.glsl"
#include "../cell.glsl"
#include "bent_image.glsl"
#include "list.glsl"
#ifdef OCCLUDERS
#include "../coverage.glsl"
#endif
#include "state.glsl"
#include "between.glsl"

// The part's values, with those of clip_part.glsl.
struct Part {
  Patch pixels;
  vec4 light, light_bends;  // at the corners, and their second differences along the sides
#ifdef OCCLUDERS
  vec2 fronts[4];
#endif
};
Part part;

// The quadrilateral or triangle that is drawn of it: its first, second and last corner.
vec2 pixels[3];
float area_px;       // of the whole
float transmission;  // its mean, or twice that of a quadrilateral

// Values at the first, second and last corner of what is drawn.
vec2[3] drawn_corners(vec2 at[4]) {
  return vec2[3](at[0], drawn == SECOND_HALF ? at[2] : at[1], drawn == FIRST_HALF ? at[2] : at[3]);
}

// The stop points of the corners at the last crossing, where the item has a stop pattern.
uint pattern = 0u;
vec2 last_stops[3];
bool is_dimmed = false;  // the triangle, by more than rims and the sharp iris
#define MEAN_OF_BENDS (1.0 / 24.0)  // of a square's parabolas, by the sum of the four second differences
#define MOST_LEVEL 2.0  // of a polygon's density, by that of its part, and the inverse
#ifdef OCCLUDERS
#define IS_OCCLUDED true
// Shadows are sharper than most fringes, so that all triangles in a pixel must have the mean over the pixel, or each of
// them the mean over itself, where a pixel sees much of the stop.
#define LARGE_PX 0.001
#define LARGE_OF_WIDE_PX 1.0
#define WIDE 0.1
float least_thickness(float longest) { return min(0.1 * longest, 1.0); }  // px
#else
#define IS_OCCLUDED false
#define LARGE_PX 1.0           // smaller triangles have the mean transmittance of their part of the stop
#define LARGE_OF_WIDE_PX 2.0   // the same where a pixel is WIDE of the stop
#define WIDE 0.5               // stop radii
float least_thickness(float longest) { return 1.0; }  // px
#endif

// A place in the part, along the sides of the triangle that is drawn, from its first corner to the others.
vec2 in_triangle(vec2 at) { return drawn == FIRST_HALF ? vec2(at.x - at.y, at.y) : vec2(at.x, at.y - at.x); }

vec2 middle_of_part;  // in the triangle
float part_of_triangle;

void find_middle(float fraction) {
  part_of_triangle = fraction;
  middle_of_part = vec2(0.0);
  for (int k = 0; k < corner_count; ++k) middle_of_part += in_triangle(polygon[k]);
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

// Lists what clips have left of the part: its flux, its density and its bounds in pixels.
void list_part(float flux, Density density, vec2 low, vec2 high) {
  bool is_point = floor(low) == floor(high);
  vec2 from = low, to = low;
  // The corners are compared in pairs only if the polygon is thin for its bounds.
  if (area_px < SLIVER * dot(high - low, high - low)) farthest_corners(from, to);
  bool is_line = area_px < SLIVER * dot(to - from, to - from);
  float dimmed = 1.0;
#ifdef OCCLUDERS
  if (is_dimmed) dimmed = set_occluders(is_point, is_line);
#else
  if (is_dimmed && (is_point || is_line || !set_pattern_map())) dimmed = mean_transmittance();
#endif
  density.value *= dimmed;
  density.gradient *= dimmed;
  if (is_point || is_line) density = Density(vec2(0.0), flux * dimmed, vec2(0.0));
  list_any(is_point, is_line, from, to, density, low, high);
}

// The pixel of a place between straight sides.
vec2 pixel_between(vec2 at) {
  if (drawn == WHOLE) return bilinear(part.pixels, at);
  vec2 along = in_triangle(at);
  return pixels[0] + (pixels[1] - pixels[0]) * along.x + (pixels[2] - pixels[0]) * along.y;
}

// The distance of the pixel from there, since the sides bend. The side between two halves is straight.
vec2 distance_of_bends(vec2 at) {
  if (drawn == WHOLE) return value_at(part.pixels, at) - bilinear(part.pixels, at);
  vec2 along = in_triangle(at), bend_of_middle = part.pixels.bends[drawn == FIRST_HALF ? 1 : 2];
  vec2 bend_of_first = part.pixels.bends[drawn == FIRST_HALF ? 0 : 3];
  float by_first = (1.0 - along.x - along.y) * (drawn == FIRST_HALF ? along.x : along.y);
  return -0.5 * (by_first * bend_of_first + along.x * along.y * bend_of_middle);
}

vec2 middle_of_drawn() {
  return drawn == WHOLE ? bilinear(part.pixels, vec2(0.5)) : (pixels[0] + pixels[1] + pixels[2]) * (1.0 / 3.0);
}

float bend_of_light() { return dot(part.light_bends, vec4(MEAN_OF_BENDS)); }

// The mean light of a polygon about a place, as triangle_weight counts it: twice for the part as a whole, which has two
// triangles. area: the polygon's, by what is drawn. Its variance along each side is taken for that of a square.
float light_about(vec2 at, float area) {
  if (drawn == WHOLE) {
    vec2 t = parabolas(at);
    float bend = t.x * mix(part.light_bends.x, part.light_bends.z, at.y) +
                 t.y * mix(part.light_bends.w, part.light_bends.y, at.x);
    return 2.0 * max(dot(corner_weights(at), part.light) - bend + 0.5 * area * bend_of_light(), 0.0);
  }
  vec2 along = in_triangle(at);
  vec3 light = drawn == FIRST_HALF ? part.light.xyz : part.light.xzw;
  return max(light.x + (light.y - light.x) * along.x + (light.z - light.x) * along.y - bend_of_light(), 0.0);
}

// Adds the bulge of an edge of the polygon, if it lies on a side of the part. Edges at rims have none, since no neighbour
// draws the light that they would leave out.
#define ON_SIDE 1e-4
void add_bulge_of_edge(inout Bulges bulges, vec2 from_in_part, vec2 to_in_part, vec2 from, vec2 to) {
  vec2 low = min(from_in_part, to_in_part), high = max(from_in_part, to_in_part), extent = high - low;
  bool on_row = high.y < ON_SIDE || low.y > 1.0 - ON_SIDE, on_column = high.x < ON_SIDE || low.x > 1.0 - ON_SIDE;
  vec2 bend = on_row      ? extent.x * extent.x * (low.y < 0.5 ? part.pixels.bends[0] : part.pixels.bends[2])
              : on_column ? extent.y * extent.y * (low.x < 0.5 ? part.pixels.bends[3] : part.pixels.bends[1])
                          : vec2(0.0);
  add_bulge(bulges, from, to, mean_distance_of(bend));
}

void list_drawn(vec2 gradient) {
  clip_part(HAS_PICTURE ? 0u : pattern == 0u ? crossings_of(item) : crossings_of(item) - 1u);
  if (corner_count < 3) return;
  float fraction = (drawn == WHOLE ? 0.5 : 1.0) * abs(twice_polygon_area());
  find_occluders();
  if (is_dimmed) find_middle(fraction);
  vec2 low = vec2(FAILED), high = vec2(-FAILED);
  // Sums over the polygon's triangles from its first corner: of twice their areas in pixels, in pixels between
  // straight sides, and in the part; and of three times their middles by these, from the first corner.
  float area = 0.0, straight_area = 0.0, area_in_part = 0.0;
  vec2 middle = vec2(0.0), middle_in_part = vec2(0.0);
  vec2 origin_in_part = polygon[0], origin = pixel_between(polygon[0]);
  vec2 bent_origin = origin + distance_of_bends(polygon[0]);
  vec2 before = vec2(0.0), straight_before = vec2(0.0), before_in_part = vec2(0.0);
  Bulges bulges = Bulges(0.0, vec2(0.0));  // from the first corner
  for (int k = 0; k < corner_count; ++k) {
    vec2 place = polygon[k], in_part = place - origin_in_part, straight = pixel_between(place) - origin;
    vec2 here = origin + straight + distance_of_bends(place);
    polygon[k] = here;
    low = min(low, here);
    high = max(high, here);
    here -= bent_origin;
    float by = cross2(before, here), by_in_part = cross2(before_in_part, in_part);
    area += by;
    straight_area += cross2(straight_before, straight);
    area_in_part += by_in_part;
    middle += by * (before + here);
    middle_in_part += by_in_part * (before_in_part + in_part);
    add_bulge_of_edge(bulges, origin_in_part + before_in_part, place, before, here);
    before = here;
    straight_before = straight;
    before_in_part = in_part;
  }
  add_bulge_of_edge(bulges, origin_in_part + before_in_part, origin_in_part, before, vec2(0.0));
  // The polygon's flux is its area of the entrance plane by the light at its centroid there. The density is this flux
  // by the area in pixels, but stays near that of the part, since the areas of thin polygons are uncertain.
  middle_in_part = origin_in_part + (area_in_part != 0.0 ? middle_in_part / (3.0 * area_in_part) : vec2(0.0));
  float flux = triangle_weight * light_about(middle_in_part, fraction) * fraction;
  float of_part = triangle_weight * transmission / area_px;
  Density density = Density(middle_of_drawn(), of_part, vec2(0.0));
  if (area * straight_area > 0.0) {
    if (area_px < SHADED_CELL_PX) bulges = Bulges(0.0, vec2(0.0));
    density = density_of(flux, 0.5 * area, middle / (3.0 * area), bulges, vec2(0.0));
    density.point = clamp(bent_origin + density.point, low, high);
    density.value = clamp(density.value, of_part / MOST_LEVEL, of_part * MOST_LEVEL);
  }
  density.gradient = gradient * density.value;
  list_part(flux, density, low, high);
}

// Reads a square part of the cell. Corners of the cell are its rays, of which some may fail.
void read_part(vec2 low, float size) {
  vec4 values[12];
  find_around(values);
  Patch4 rays = part_of_cell(whole_cell(values), low, size, true);
  for (int k = 0; k < 4; ++k) {
    part.pixels.corners[k] = rays.corners[k].xy - vec2(base);
    part.pixels.bends[k] = rays.bends[k].xy;
    heights_of_part[k] = rays.corners[k].w;
    height_bends_of_part[k] = rays.bends[k].w;
  }
  part.light = vec4(rays.corners[0].z, rays.corners[1].z, rays.corners[2].z, rays.corners[3].z);
  part.light_bends = vec4(rays.bends[0].z, rays.bends[1].z, rays.bends[2].z, rays.bends[3].z);
  for (uint c = 0u; c < MAX_CROSSINGS; ++c) {
    if (c >= crossings_of(item)) continue;
    for (int k = 0; k < 12; ++k) values[k] = exists[k] ? vec4(crossing(around[k], c), 0.0, 0.0) : vec4(0.0);
    stops_of_part[c] = first_two(part_of_cell(whole_cell(values), low, size, false));
  }
#ifdef OCCLUDERS
  const vec2 corners[4] = vec2[4](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0));
  for (int k = 0; k < 4; ++k) part.fronts[k] = front_at(low + size * corners[k]);
#endif
}

// The points at which the triangle's rays cross the stop, for a linear map: moved by the mean of what they bend.
vec2[3] stops_of_drawn(uint c) {
  vec2 bends[4] = stops_of_part[c].bends, bend = bends[0] + bends[1] + bends[2] + bends[3];
  vec2 at[3] = drawn_corners(stops_of_part[c].corners);
  for (int k = 0; k < 3; ++k) at[k] -= MEAN_OF_BENDS * bend;
  return at;
}

void set_drawn(uint how) {
  drawn = how;
#ifdef OCCLUDERS
  front_of_triangle = drawn_corners(part.fronts);
  for (uint c = 0u; c < MAX_CROSSINGS; ++c)
    if (c < crossings_of(item)) stops_of_triangle[c] = stops_of_drawn(c);
#endif
  if (pattern != 0u) last_stops = stops_of_drawn(crossings_of(item) - 1u);
  vec2 corners[4] = part.pixels.corners;
  vec2 a = corners[0], b = corners[1], c = corners[2], d = corners[3];
  float first_half = max((part.light.x + part.light.y + part.light.z) / 3.0 - bend_of_light(), 0.0);
  float second_half = max((part.light.x + part.light.z + part.light.w) / 3.0 - bend_of_light(), 0.0);
  transmission = (how == SECOND_HALF ? 0.0 : first_half) + (how == FIRST_HALF ? 0.0 : second_half);
  pixels = drawn_corners(corners);
  area_px = 0.5 * abs(how == WHOLE ? cross2(c - a, d - b) : cross2(pixels[1] - a, pixels[2] - a));
}

// Whether the part's image is not about to fold, so that its sides bend little.
#define LEAST_CORNER 0.2  // the area of the parallelogram at a corner of a quadrilateral, by the mean
bool is_unfolded() {
  vec2 a = part.pixels.corners[0], b = part.pixels.corners[1], c = part.pixels.corners[2], d = part.pixels.corners[3];
  vec4 areas = vec4(cross2(b - a, d - a), cross2(c - b, a - b), cross2(d - c, b - c), cross2(a - d, c - d));
  float least = LEAST_CORNER * 0.25 * abs(areas.x + areas.y + areas.z + areas.w);
  return all(greaterThan(areas, vec4(least))) || all(lessThan(areas, vec4(-least)));
}

// The relative irradiance at a corner of the part: its light by the area of the parallelogram of the sides' directions
// there. 0 if its image folds.
float irradiance_of_corner(int k, float orientation) {
  int next = (k + 1) & 3, before = (k + 3) & 3;
  vec2 here = part.pixels.corners[k];
  vec2 along = part.pixels.corners[next] - here - 0.5 * part.pixels.bends[k];
  vec2 back = part.pixels.corners[before] - here - 0.5 * part.pixels.bends[before];
  float area = cross2(along, back) * orientation;
  return area > 0.0 ? part.light[k] / area : 0.0;
}

// The change of the part's density by its mean. Cells beside rays that fail have one, too.
#define DIMMEST_CORNER 0.1  // of the sum of all; below, the part is about to fold, and the gradient vanishes
vec2 gradient_of_part() {
  vec2 d = part.pixels.corners[2] - part.pixels.corners[0], f = part.pixels.corners[3] - part.pixels.corners[1];
  float twice_area = cross2(d, f);
  if (abs(twice_area) < 2.0 * SHADED_CELL_PX) return vec2(0.0);
  vec4 e;
  for (int k = 0; k < 4; ++k) e[k] = irradiance_of_corner(k, sign(twice_area));
  float dimmest = min(min(e.x, e.y), min(e.z, e.w)) / max(e.x + e.y + e.z + e.w, 1e-37);
  return dimmest > 0.0 ? gradient_along(d, f, e) * min(dimmest / DIMMEST_CORNER, 1.0) : vec2(0.0);
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
  fails = bvec4(failed(ray_of(v.x)), failed(ray_of(v.y)), failed(ray_of(v.z)), failed(ray_of(v.w)));
  if (fails.x || fails.z || fails.y && fails.w) return;
  float size = 1.0 / float(parts);
  read_part(vec2(number % parts, number / parts) * size, size);
  triangle_weight *= size * size;
  vec2 gradient = gradient_of_part();
  bool is_linear = !is_unfolded();
  if (is_linear) part.pixels.bends = vec2[4](vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0));
  // Patterns and occluders are linear over triangles.
  bool has_halves = !any(fails) && (IS_OCCLUDED || pattern != 0u || is_linear);
  uint how = fails.y ? SECOND_HALF : fails.w || has_halves ? FIRST_HALF : WHOLE;
  bool is_last;
  do {
    set_drawn(how);
    list_drawn(gradient);
    is_last = how != FIRST_HALF || !has_halves;
    how = SECOND_HALF;
  } while (!is_last);
}
