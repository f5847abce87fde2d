// SPDX-License-Identifier: Apache-2.0
// Values between the rays of a grid: bilinear in a cell, with the curvature that the rays around it show. All values are
// the same sums over twelve rays.
//
//        0  1
//     2  3  4  5      the cell is 3, 4, 8, 7
//     6  7  8  9
//       10 11
// An open cell is drawn with straight sides (cells.comp). Points of a side that it shares lie on a straight line here,
// too, so that no seam shows.
uint around[12];
vec4 rays_around[12];
bool exists[12];
bvec4 side_is_straight;  // the side below, above, on the left, on the right

const ivec2 kAround[12] = ivec2[12](ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0), ivec2(0, 0), ivec2(1, 0), ivec2(2, 0),
                                    ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1), ivec2(2, 1), ivec2(0, 2), ivec2(1, 2));

bool is_uniform(uint pattern, uvec4 k) {
  return region_of_rays(pattern, around[k.x], around[k.y], around[k.z], around[k.w], crossings_of(item)) ==
         REGION_UNIFORM;
}

void find_around() {
  ivec2 cell = ivec2(own % side, own / side);
  for (int k = 0; k < 12; ++k) {
    ivec2 at = cell + kAround[k];
    bool inside = at.x >= 0 && at.y >= 0 && at.x < int(side) && at.y < int(side);
    around[k] = inside ? ray_at(uint(at.x), uint(at.y)) : 0u;
    rays_around[k] = ray_of(around[k]);
    exists[k] = inside && !failed(rays_around[k]);
  }
  bool open[12];
  for (int k = 0; k < 12; ++k) open[k] = exists[k] && passes(around[k]);
  side_is_straight = bvec4(open[0] && open[1] && open[3] && open[4], open[7] && open[8] && open[10] && open[11],
                           open[2] && open[6] && open[3] && open[7], open[4] && open[8] && open[5] && open[9]);
  uint pattern = pattern_of(item);
  if (pattern == 0u) return;
  // Cells where the stop pattern varies are drawn in parts, too.
  side_is_straight = bvec4(side_is_straight.x && is_uniform(pattern, uvec4(0u, 1u, 4u, 3u)),
                           side_is_straight.y && is_uniform(pattern, uvec4(7u, 8u, 11u, 10u)),
                           side_is_straight.z && is_uniform(pattern, uvec4(2u, 3u, 7u, 6u)),
                           side_is_straight.w && is_uniform(pattern, uvec4(4u, 5u, 9u, 8u)));
}

float weights[12];

// Subtracts t (1 - t) / 2 times the mean second difference along a row of rays, as far as there are rays.
void bend(int before, int first, int last, int after, float amount) {
  float count = float(exists[before]) + float(exists[after]);
  if (count == 0.0) return;
  float by = amount / count;
  if (exists[before]) {
    weights[before] -= by;
    weights[first] += 2.0 * by;
    weights[last] -= by;
  }
  if (exists[after]) {
    weights[first] -= by;
    weights[last] += 2.0 * by;
    weights[after] -= by;
  }
}

bool is_on_straight_row(vec2 at) {
  return side_is_straight.x && at.y == 0.0 || side_is_straight.y && at.y == 1.0;
}
bool is_on_straight_column(vec2 at) {
  return side_is_straight.z && at.x == 0.0 || side_is_straight.w && at.x == 1.0;
}

// along_row, along_column: whether values bend there, or are linear.
void set_weights(vec2 at, bool along_row, bool along_column) {
  for (int k = 0; k < 12; ++k) weights[k] = 0.0;
  weights[3] = (1.0 - at.x) * (1.0 - at.y);
  weights[4] = at.x * (1.0 - at.y);
  weights[7] = (1.0 - at.x) * at.y;
  weights[8] = at.x * at.y;
  vec2 amount = 0.5 * at * (1.0 - at);
  if (along_row) {
    bend(2, 3, 4, 5, amount.x * (1.0 - at.y));
    bend(6, 7, 8, 9, amount.x * at.y);
  }
  if (along_column) {
    bend(0, 3, 7, 10, amount.y * (1.0 - at.x));
    bend(1, 4, 8, 11, amount.y * at.x);
  }
}

// Adds what values bend at a ray along a row or column, as far as there are rays.
void add_bend(int before, int at, int after, float amount) {
  if (!exists[before] || !exists[after]) return;
  weights[before] -= amount;
  weights[at] += 2.0 * amount;
  weights[after] -= amount;
}

// Moves values at a corner of a part by the mean of what they bend from the linear in it, as the rays about the cell's
// corners show: parts that share a corner move it alike.
void add_mean_bend(vec2 at, float size) {
  if (!(exists[3] && exists[4] && exists[7] && exists[8])) return;
  float amount = size * size * (1.0 / 12.0);  // the mean of t (1 - t) / 2
  vec4 by = amount * vec4((1.0 - at.x) * (1.0 - at.y), at.x * (1.0 - at.y), (1.0 - at.x) * at.y, at.x * at.y);
  add_bend(2, 3, 4, by.x);
  add_bend(0, 3, 7, by.x);
  add_bend(3, 4, 5, by.y);
  add_bend(1, 4, 8, by.y);
  add_bend(6, 7, 8, by.z);
  add_bend(3, 7, 10, by.z);
  add_bend(7, 8, 9, by.w);
  add_bend(4, 8, 11, by.w);
}

vec4 ray_between() {
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 12; ++k) sum += weights[k] != 0.0 ? weights[k] * rays_around[k] : vec4(0.0);
  return sum;
}
