// SPDX-License-Identifier: Apache-2.0
// Clips a part of a cell by rims and the iris, whose edges are curved in it. Places are in the part: its corners are
// (0, 0), (1, 0), (1, 1), (0, 1).
#include "../polygon.glsl"
#include "patch.glsl"

// The function that clips: its values at the part's corners, and its second differences along the sides.
vec4 corners_of_bound, bends_of_bound;

float bound_at(vec2 at) {
  vec2 t = parabolas(at);
  return dot(corner_weights(at), corners_of_bound) - t.x * mix(bends_of_bound.x, bends_of_bound.z, at.y) -
         t.y * mix(bends_of_bound.w, bends_of_bound.y, at.x);
}
#define CURVED true
#include "../cut_polygon.glsl"

// The part is drawn whole, or in halves.
#define WHOLE 0u
#define FIRST_HALF 1u
#define SECOND_HALF 2u
uint drawn = WHOLE;

// The place of a corner among those that are drawn: of the fourth one of a half, which is not, the first one.
int drawn_corner(int k) { return drawn == FIRST_HALF && k == 3 || drawn == SECOND_HALF && k == 1 ? 0 : k; }

void begin_part() {
  const vec2 corners[4] = vec2[4](vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0));
  int skipped = drawn == SECOND_HALF ? 1 : 4;
  for (int k = 0; k < FEW_CORNERS; ++k) few[k] = corners[min(k < skipped ? k : k + 1, 3)];
  has_few = true;
  corner_count = drawn == WHOLE ? 4 : 3;
}

// The corners, with the first one in place of one that is not drawn.
vec4 drawn_values(vec4 at) {
  return vec4(at.x, drawn == SECOND_HALF ? at.x : at.y, at.z, drawn == FIRST_HALF ? at.x : at.w);
}
bool any_beyond(vec4 at) { return any(greaterThan(drawn_values(at), vec4(0.0))); }

// A bound of the iris, as two bound_half().
struct IrisBound {
  vec4 line, circle;
};
bool is_circle() { return (p.flags & FLAG_CIRCLE) != 0u; }
uint bounds_of_iris() { return is_circle() ? 1u : p.bound_count; }
IrisBound iris_bound(uint b) {
  const IrisBound unit_circle = IrisBound(vec4(0.0), vec4(0.0, 0.0, 1.0, -1.0));  // the last: the power of the origin
  if (is_circle()) return unit_circle;
  return IrisBound(bound_half(2u * b), bound_half(2u * b + 1u));
}

// The distance of a point at the stop beyond a bound, as bound_distance().
float distance_from(IrisBound bound, vec2 q) {
  vec4 line = bound.line, circle = bound.circle;
  float power = dot(q, q) - 2.0 * dot(circle.xy, q) + circle.w;
  return line.w != 0.0 ? dot(line.xy, q) - line.z : power / (length(q - circle.xy) + circle.z);
}

vec4 corner_distances(IrisBound bound, Patch stops) {
  return vec4(distance_from(bound, stops.corners[0]), distance_from(bound, stops.corners[1]),
              distance_from(bound, stops.corners[2]), distance_from(bound, stops.corners[3]));
}

// The second differences of the distance along the sides, from their middles.
vec4 distance_bends(IrisBound bound, Patch stops, vec4 corners) {
  vec4 bends;
  for (int k = 0; k < 4; ++k) {
    int next = (k + 1) & 3;
    vec2 middle = 0.5 * (stops.corners[k] + stops.corners[next]) - 0.125 * stops.bends[k];
    bends[k] = 4.0 * (corners[k] + corners[next] - 2.0 * distance_from(bound, middle));
  }
  return bends;
}

// The disc about the drawn corners at the stop, from the middle of a circle.
void find_disc(Patch stops, vec2 centre, out vec2 middle, out float half_extent) {
  vec2 corners[4];
  for (int k = 0; k < 4; ++k) corners[k] = stops.corners[drawn_corner(k)] - centre;
  middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  half_extent = 0.0;
  for (int k = 0; k < 4; ++k) half_extent = max(half_extent, length(corners[k] - middle));
}

// The part that is clipped: the points at which its rays cross the stop, and their relative heights.
Patch stops_of_part[MAX_CROSSINGS];
vec4 heights_of_part, height_bends_of_part;
Patch stops_at(uint c) {
  Patch stops = stops_of_part[0];
  for (uint other = 1u; other < MAX_CROSSINGS; ++other) {
    for (int k = 0; k < 4; ++k) {
      if (c == other) stops.corners[k] = stops_of_part[other].corners[k];
      if (c == other) stops.bends[k] = stops_of_part[other].bends[k];
    }
  }
  return stops;
}

// Bounds are numbered: the rims, then those of the iris at one crossing after the other.
#define RIMS 0u
bool clips(uint number) {
  if (number == RIMS) return any_beyond(heights_of_part - 1.0);
  uint k = number - 1u;
  return any_beyond(corner_distances(iris_bound(k % bounds_of_iris()), stops_at(k / bounds_of_iris())));
}

// The largest angle of an arc in a part by the root of its radius from 1 on, for which a point between the ends of its
// edge will do. Tangents stand for others.
#define MOST_HALF_ANGLE 0.075

void clip_by(uint number) {
  uint k = number == RIMS ? 0u : number - 1u;
  IrisBound bound = iris_bound(k % bounds_of_iris());
  Patch stops = stops_at(k / bounds_of_iris());
  vec2 middle;
  float half_extent, radius = bound.circle.z;
  find_disc(stops, bound.circle.xy, middle, half_extent);
  bool by_tangents = number != RIMS && bound.line.w == 0.0 &&
                     half_extent * sqrt(max(radius, 1.0)) > MOST_HALF_ANGLE * length(middle);
  Arc arc = Arc(0.0, 0.0, 1);
  if (by_tangents) arc = arc_within(middle, half_extent, radius);
  for (int j = 0; j < arc.tangents; ++j) {
    if (by_tangents) {
      vec2 normal = tangent_normal(arc, j);
      bound.line = vec4(normal, radius + dot(normal, bound.circle.xy), 1.0);
    }
    corners_of_bound = corner_distances(bound, stops);
    bends_of_bound = distance_bends(bound, stops, corners_of_bound);
    if (number == RIMS) corners_of_bound = heights_of_part - 1.0;
    if (number == RIMS) bends_of_bound = height_bends_of_part;
    if (any_beyond(corners_of_bound)) cut_by_bound();
  }
}

// Leaves what passes the rims, and the iris at a number of crossings. Bounds are found before they clip, 32 at a time,
// and all clip at one place: lavapipe clips in each turn of a loop in which one invocation does, and on both sides of
// branches.
void clip_part(uint crossing_count) {
  begin_part();
  uint count = 1u + crossing_count * bounds_of_iris();
  for (uint from = 0u; from < count; from += 32u) {
    uint left = 0u, end = min(from + 32u, count);
    for (uint k = from; k < end; ++k) left |= clips(k) ? 1u << (k - from) : 0u;
    for (; left != 0u && corner_count >= 3; left &= left - 1u) clip_by(from + uint(findLSB(left)));
  }
  end_cuts();
}
