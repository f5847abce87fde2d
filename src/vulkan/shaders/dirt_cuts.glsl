// SPDX-License-Identifier: Apache-2.0
// The shadows of dirt in a part of a triangle of rays (picture_cuts.glsl), as polygons drawn as negative light:
// render/bundle/cell_raster.cpp, draw_shadows(). A large stroke's edge is straight in a part; others have octagons in
// place of their round ends. Included after grid_stop.glsl and picture_cuts.glsl.
#define MOST_SHADOWS 8       // of a part that are drawn as polygons; others dim all of the part by their mean
#define SHADOW_PART_PX 1.0   // of a part's sides
#define LARGE_STROKE 3.0     // half the width over a part's sides, from which on the edge is straight in a part
// The chord of a large stroke's round end lies within it, by about this over the part's longest side squared and times
// the radius: it is moved outwards, so that shadows keep their areas. Fitted to the fluxes of the CPU's frames.
#define BULGE 0.04
// Half a round end of radius 1 as three sides of an octagon, whose area is that of half a disc: the distance of the end
// from the stroke's line, and the distance of its corners, as the sum of both coordinates.
#define END_REACH 0.96
#define CORNER_REACH 1.369

uint shadow_strokes[MOST_SHADOWS], shadow_planes[MOST_SHADOWS];
float shadow_opacities[MOST_SHADOWS];
int shadow_count = 0;
float unshadowed;  // the factor of strokes that cover the whole part, and of those that are too many

// A signed distance from a stroke's edge, from the point along and across it.
float stroke_distance(Stroke s, vec2 own) {
  return length(vec2(max(abs(own.x) - s.half_length, 0.0), own.y)) - s.half_width;
}

// The corners of a part in the plane of the dirt, mm.
vec2[3] part_in_plane(uint k, vec2 corner, float size) {
  SeenPlane plane = plane_at(k);
  float mm = dirt_float(DIRT_MM_A_UNIT);
  vec2 at = point_in(plane, corner) * mm;
  return vec2[3](at, at + plane.u * (size * mm), at + plane.v * (size * mm));
}

float longest_side(vec2 q[3]) {
  return max(max(length(q[1] - q[0]), length(q[2] - q[1])), length(q[0] - q[2]));
}

// The parts a side of the triangle, so that edges are about straight, and strokes are listed for the cell of a part.
int shadow_parts(vec2 pixels[3]) {
  float most = longest_side(pixels) / SHADOW_PART_PX;
  for (uint k = 0u; k < POINTS; ++k)
    if (has_dirt_at(k, seen_crossings))
      most = max(most, longest_side(part_in_plane(k, vec2(0.0), 1.0)) / dirt_cell_mm());
  return clamp(int(ceil(most)), 1, MOST_PICTURE_PARTS);
}

void find_shadows_in(uint k, vec2 corner, float size) {
  vec2 q[3] = part_in_plane(k, corner, size), middle = (q[0] + q[1] + q[2]) * (1.0 / 3.0);
  float radius = max(max(length(q[0] - middle), length(q[1] - middle)), length(q[2] - middle));
  uint cell = dirt[DIRT_FIRST_AT] + dirt_cell_of(middle.y) * dirt[DIRT_CELLS] + dirt_cell_of(middle.x);
  for (uint j = dirt[cell], end = dirt[cell + 1u]; j < end; ++j) {
    uint number = dirt[dirt[DIRT_OF_CELL_AT] + j];
    Stroke s = stroke_at(number);
    vec2 from = middle - s.middle;
    float reach = s.half_length + s.half_width + radius;
    if (dot(from, from) > reach * reach) continue;
    float distance = stroke_distance(s, along_and_across(s, from));
    if (distance >= radius) continue;
    if (distance <= -radius) {
      unshadowed *= 1.0 - s.opacity;
    } else if (shadow_count < MOST_SHADOWS) {
      shadow_strokes[shadow_count] = number;
      shadow_planes[shadow_count] = k;
      shadow_opacities[shadow_count++] = s.opacity;
    } else {
      vec2 x = 0.70710678 * (q[1] - q[0]), y = 0.70710678 * (q[2] - q[0]);  // a parallelogram of the part's area
      unshadowed *= 1.0 - s.opacity * covered_fraction(s, middle, x, y);
    }
  }
}

void find_shadows(vec2 corner, float size) {
  shadow_count = 0;
  unshadowed = 1.0;
  for (uint k = 0u; k < POINTS; ++k)
    if (has_dirt_at(k, seen_crossings)) find_shadows_in(k, corner, size);
}

// The polygons of a part: all of it, each shadow, and what pairs of shadows have in common, since what one blocks the
// other does not block again.
int shadow_terms() { return 1 + shadow_count + shadow_count * (shadow_count - 1) / 2; }

// The shadows of a term; equal where it is one, -1 where it is none.
ivec2 shadows_of_term(int term) {
  if (term <= shadow_count) return ivec2(term - 1);
  int left = term - 1 - shadow_count, first = 0;
  for (; left >= shadow_count - 1 - first; ++first) left -= shadow_count - 1 - first;
  return ivec2(first, first + 1 + left);
}

float factor_of_term(ivec2 shadows) {
  if (shadows.x < 0) return unshadowed;
  float first = -shadow_opacities[shadows.x] * unshadowed;
  return shadows.x == shadows.y ? first : -first * shadow_opacities[shadows.y];
}

// The largest values of a stroke's side, end and corners, in own coordinates: eight straight edges.
float edge_of_outline(Stroke s, int axis) {
  if (axis == 0) return s.half_length + END_REACH * s.half_width;
  return axis == 1 ? s.half_width : s.half_length + CORNER_REACH * s.half_width;
}

void cut_by_shadow(int shadow, vec2 corner, float size) {
  Stroke s = stroke_at(shadow_strokes[shadow]);
  vec2 q[3] = part_in_plane(shadow_planes[shadow], corner, size);
  float longest = longest_side(q);
  vec2 own[3];
  for (int j = 0; j < 3; ++j) own[j] = along_and_across(s, q[j] - s.middle);
  bool is_large = s.half_width >= LARGE_STROKE * longest;
  bool is_at_end = max(max(abs(own[0].x), abs(own[1].x)), abs(own[2].x)) > s.half_length;
  float bulge = is_at_end ? BULGE * longest * longest / s.half_width : 0.0;
  for (int side = 0; side < (is_large ? 1 : 8); ++side) {
    vec2 way = vec2((side & 1) != 0 ? -1.0 : 1.0, (side & 2) != 0 ? -1.0 : 1.0);
    int axis = side < 2 ? 0 : side < 4 ? 1 : 2;
    vec3 values;
    for (int j = 0; j < 3; ++j) {
      vec2 at = axis == 1 ? own[j] * way.xx : own[j] * way;
      values[j] = is_large ? stroke_distance(s, own[j]) - bulge
                           : (axis == 0 ? at.x : axis == 1 ? at.y : at.x + at.y) - edge_of_outline(s, axis);
    }
    cut_part(values, corner, size);
  }
}

// Leaves the part of the present polygon that all shadows of a term cover.
void cut_by_shadows(ivec2 shadows, vec2 corner, float size) {
  if (shadows.x < 0) return;
  for (int j = 0; j < 2; ++j)
    if (j == 0 || shadows.y != shadows.x) cut_by_shadow(shadows[j], corner, size);
  end_cuts();
}
