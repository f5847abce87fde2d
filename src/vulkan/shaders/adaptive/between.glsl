// SPDX-License-Identifier: Apache-2.0
// Parts of a cell between the rays of a grid: values at a part's corners, and the second differences along its sides,
// as the rays around show them. Values in it are bilinear, less what they bend. All are the same sums over twelve rays.
//
//        0  1
//     2  3  4  5      the cell is 3, 4, 8, 7
//     6  7  8  9
//       10 11
// An open cell is drawn with straight sides (cells.comp). Corners of a part on a side that it shares lie on a straight
// line here, too, so that no seam shows. Included after patch.glsl.
#include "side_bend.glsl"

uint around[12];
bool exists[12];
bvec4 fails;             // the cell's corners
bvec4 side_is_straight;  // below, on the right, above, on the left

const ivec2 kAround[12] = ivec2[12](ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0), ivec2(0, 0), ivec2(1, 0), ivec2(2, 0),
                                    ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1), ivec2(2, 1), ivec2(0, 2), ivec2(1, 2));

bool is_uniform(uint pattern, uvec4 k) {
  return region_of_rays(pattern, around[k.x], around[k.y], around[k.z], around[k.w], crossings_of(item)) ==
         REGION_UNIFORM;
}

void find_around(out vec4 rays_around[12]) {
  ivec2 cell = ivec2(own % side, own / side);
  for (int k = 0; k < 12; ++k) {
    ivec2 at = cell + kAround[k];
    bool inside = at.x >= 0 && at.y >= 0 && at.x < int(side) && at.y < int(side);
    around[k] = inside ? ray_at(uint(at.x), uint(at.y)) : 0u;
    vec4 ray = ray_of(around[k]);
    exists[k] = inside && !failed(ray);
    rays_around[k] = exists[k] ? ray : vec4(0.0);
  }
  fails = not(bvec4(exists[3], exists[4], exists[8], exists[7]));
  bool open[12];
  for (int k = 0; k < 12; ++k) open[k] = exists[k] && passes(around[k]);
  side_is_straight = bvec4(open[0] && open[1] && open[3] && open[4], open[4] && open[8] && open[5] && open[9],
                           open[7] && open[8] && open[10] && open[11], open[2] && open[6] && open[3] && open[7]);
  uint pattern = pattern_of(item);
  if (pattern == 0u) return;
  // Cells where the stop pattern varies are drawn in parts, too.
  side_is_straight = bvec4(side_is_straight.x && is_uniform(pattern, uvec4(0u, 1u, 4u, 3u)),
                           side_is_straight.y && is_uniform(pattern, uvec4(4u, 5u, 9u, 8u)),
                           side_is_straight.z && is_uniform(pattern, uvec4(7u, 8u, 11u, 10u)),
                           side_is_straight.w && is_uniform(pattern, uvec4(2u, 3u, 7u, 6u)));
}

vec4 bend_of_side(vec4 values[12], int before, int first, int last, int after) {
  return bend_of_side(vec4[4](values[before], values[first], values[last], values[after]),
                      bvec2(exists[before], exists[after]));
}

// Values in the cell. Beside a corner that fails they are linear.
Patch4 whole_cell(vec4 values[12]) {
  Patch4 cell;
  cell.corners = vec4[4](values[3], values[4], values[8], values[7]);
  cell.bends = vec4[4](bend_of_side(values, 2, 3, 4, 5), bend_of_side(values, 1, 4, 8, 11),
                       bend_of_side(values, 6, 7, 8, 9), bend_of_side(values, 0, 3, 7, 10));
  if (!any(fails)) return cell;
  cell.bends = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  vec4 beside = cell.corners[0] + cell.corners[2];
  if (fails.y)
    cell.corners[1] = beside - cell.corners[3];
  else
    cell.corners[3] = beside - cell.corners[1];
  return cell;
}

// Values in a square part of the cell. has_straight_sides: of the first two of the values.
Patch4 part_of_cell(Patch4 cell, vec2 low, float size, bool has_straight_sides) {
  const vec2 corners[4] = vec2[4](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0));
  Patch4 part;
  for (int k = 0; k < 4; ++k) {
    vec2 at = low + size * corners[k];
    bool on_row = side_is_straight.x && at.y == 0.0 || side_is_straight.z && at.y == 1.0;
    bool on_column = side_is_straight.w && at.x == 0.0 || side_is_straight.y && at.x == 1.0;
    vec4 straight = bilinear(cell, at), by_row = bend_along_row(cell, at), by_column = bend_along_column(cell, at);
    if (has_straight_sides && on_row) by_row.xy = vec2(0.0);
    if (has_straight_sides && on_column) by_column.xy = vec2(0.0);
    part.corners[k] = straight - by_row - by_column;
  }
  float scale = size * size;
  vec2 high = low + size;
  part.bends[0] = scale * mix(cell.bends[0], cell.bends[2], low.y);
  part.bends[1] = scale * mix(cell.bends[3], cell.bends[1], high.x);
  part.bends[2] = scale * mix(cell.bends[0], cell.bends[2], high.y);
  part.bends[3] = scale * mix(cell.bends[3], cell.bends[1], low.x);
  return part;
}
