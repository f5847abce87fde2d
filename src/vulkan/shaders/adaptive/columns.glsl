// SPDX-License-Identifier: Apache-2.0
// On processors, eight invocations draw the polygons of a quarter of the tile, a column of its pixels each: what they
// read is the same for all of them, and sums stay with them.
#define QUARTER_SIDE 8
shared uint quarter_lists[4u * 32u];
shared uint quarter_counts[4];
#define MOST_WAITING 1024u
shared uint waiting[MOST_WAITING];  // polygons; from the end on those that may cover a quarter
shared uint waiting_count, large_count;

ivec2 low_of_quarter(uint quarter) { return QUARTER_SIDE * ivec2(quarter & 1u, quarter >> 1u); }  // in the tile

// The areas of a column's pixels to the right of an edge, as area_right_of(), subtracted.
void subtract_areas(inout float covered[ROWS], vec2 a, vec2 b) {
  vec2 low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
  float slope = high.y > low.y ? (high.x - low.x) / (high.y - low.y) : 0.0, sign = a.y < b.y ? -1.0 : 1.0;
  float y_before = clamp(0.0, low.y, high.y), x_before = low.x + slope * (y_before - low.y);
  [[unroll]] for (int row = 0; row < ROWS; ++row) {
    float y = clamp(float(row + 1), low.y, high.y), x = low.x + slope * (y - low.y);
    float x0 = min(x_before, x), x1 = max(x_before, x), left = clamp(x0, 0.0, 1.0), right = clamp(x1, 0.0, 1.0);
    float sum = (min(x1, 0.0) - min(x0, 0.0)) + (right - left) * (1.0 - 0.5 * (left + right));
    covered[row] += sign * (y - y_before) * (x1 > x0 ? sum / (x1 - x0) : 1.0 - left);
    y_before = y;
    x_before = x;
  }
}

// Draws a polygon of three corners or more into an invocation's column.
void draw_column(uint number, ivec2 column_low) {
  Polygon q = polygon_of(number);
  uint first = first_of(q), count = count_of(q);
  vec2 corner = vec2(column_low - base_of(q));
  float covered[ROWS];
  [[unroll]] for (int row = 0; row < ROWS; ++row) covered[row] = 0.0;
  vec2 before = last_corner(q) - corner;
  for (uint k = 0u; k < count; k += 4u) {
    Corners four = corners_from(first + k, count - k);
    subtract_areas(covered, before, four.a - corner);
    subtract_areas(covered, four.a - corner, four.b - corner);
    subtract_areas(covered, four.b - corner, four.c - corner);
    subtract_areas(covered, four.c - corner, four.d - corner);
    before = four.d - corner;
  }
  vec3 gain = gain_of(q);
  vec2 gradient = gradient_of(q);
  ivec4 box = box_of(number);
  float inside = column_low.x >= box.x && column_low.x <= box.z ? 1.0 : 0.0;
  float value = value_of(q) + dot(gradient, corner + 0.5 - point_of(q));
  [[unroll]] for (int row = 0; row < ROWS; ++row)
    add(row, inside * max(covered[row], 0.0) * (value + float(row) * gradient.y), gain);
}

// Lists a polygon for the quarters that it reaches; of large polygons, for those that it does not cover.
void list_by_quarter(InTile one, bool may_cover) {
  for (uint quarter = 0u; quarter < 4u; ++quarter) {
    ivec2 low = tile_low + low_of_quarter(quarter), high = low + QUARTER_SIDE - 1;
    ivec4 box = one.box;
    if (box.x > high.x || box.y > high.y || box.z < low.x || box.w < low.y) continue;
    bool is_full = may_cover && box.x <= low.x && box.y <= low.y && box.z >= high.x && box.w >= high.y;
    if (is_full && covers(one.q, vec2(low - base_of(one.q)), float(QUARTER_SIDE)))
      add_plane(1u + quarter, one.q, vec2(tile_low - base_of(one.q)));
    else
      quarter_lists[32u * quarter + atomicAdd(quarter_counts[quarter], 1u)] = one.number;
  }
}

void draw_quarters() {
  uint quarter = gl_LocalInvocationIndex / 8u, count = quarter_counts[quarter], j = 0u;
  ivec2 low = tile_low + low_of_quarter(quarter) + ivec2(gl_LocalInvocationIndex % 8u, 0);
  for (; j < count; ++j) draw_column(quarter_lists[32u * quarter + j], low);
  check_end(j, count);
}

// Draws the polygons that wait, either the large ones or the others.
void draw_waiting(bool large) {
  uint t = gl_LocalInvocationIndex, count = large ? large_count : waiting_count, from = 0u;
  for (; from < count; from += 32u) {
    if (t < 4u) quarter_counts[t] = 0u;
    barrier();
    uint k = from + t;
    if (k < count) list_by_quarter(in_tile(waiting[large ? MOST_WAITING - 1u - k : k]), large);
    barrier();
    draw_quarters();
    barrier();
  }
  check_end(from, count);
}

// Draws polygons of few pixels and corners, one an invocation. The others wait.
void draw_few_pixels(uint number) {
  InTile one = in_tile(number);
  ivec4 box = one.box - tile_low.xyxy, quarters = box / QUARTER_SIDE;
  int pixels = (box.z - box.x + 1) * (box.w - box.y + 1);
  int quarter_count = (quarters.z - quarters.x + 1) * (quarters.w - quarters.y + 1);
  bvec2 before = lessThanEqual(box.xy, ivec2(0)), after = greaterThanEqual(box.zw, ivec2(TILE_SIDE - 1));
  bvec2 first = greaterThanEqual(box.zw, ivec2(QUARTER_SIDE - 1)), second = lessThanEqual(box.xy, ivec2(QUARTER_SIDE));
  bool may_cover = ((before.x && first.x) || (second.x && after.x)) && ((before.y && first.y) || (second.y && after.y));
  uint corners = count_of(one.q);
  if (corners < 3u || (corners <= 4u && pixels <= p.small_px * quarter_count))
    draw_small(one.q, one.box);
  else if (may_cover)
    waiting[MOST_WAITING - 1u - atomicAdd(large_count, 1u)] = number;
  else
    waiting[atomicAdd(waiting_count, 1u)] = number;
}

// Draws a part of the tile's list; returns where it ended. Each kind of polygons has a loop of its own, as processors
// would execute the code for all of them.
uint draw_by_columns(uint from, uint end) {
  uint t = gl_LocalInvocationIndex;
  while (from < end) {
    if (t == 0u) waiting_count = large_count = 0u;
    barrier();
    uint least = min(end, from + MOST_WAITING);  // all of them may have to wait
    for (; from < least; from += 32u)
      if (from + t < least) draw_few_pixels(texelFetch(list_texels, int(from + t)).x);
    barrier();
    draw_waiting(false);
    draw_waiting(true);
  }
  return from;
}
