// SPDX-License-Identifier: Apache-2.0
// Cuts the polygon (polygon.glsl) by a bound, and keeps the part where the bound's function is <= 0
// (Sutherland-Hodgman): bound_at(), which whoever includes this file defines. Whoever defines CURVED as true has bounds
// that are not linear: the points at which they cross sides of the polygon are refined, and their edges have one point
// more, between these.
#ifndef CURVED
#define CURVED false
#endif

int first_corner = 0;
// A polygon of few corners is here while it is cut, without indices that vary, which would keep it in memory: on
// lavapipe each such number is written in a branch of its own.
#define FEW_CORNERS 8
#define MORE_AFTER_CUT (CURVED ? 2 : 1)  // the corners that a convex polygon has more after a cut, at most
vec2 few[FEW_CORNERS];
bool has_few;

// A side of the polygon that a bound crosses, the bound's values at its ends, and the place of the crossing among the
// new corners.
struct CrossedSide {
  vec2 from, to;
  float at_from, at_to;
  int place;  // < 0: there is none
};
const CrossedSide kNotCrossed = CrossedSide(vec2(0.0), vec2(0.0), 0.0, 0.0, -1);

// The edge that a cut makes: from where the polygon leaves the bound to where it enters.
struct CutEdge {
  CrossedSide leaves, enters;
  int middle_place;
};
const CutEdge kNoEdge = CutEdge(kNotCrossed, kNotCrossed, -1);

// The crossing of a bound whose function is about a parabola along the side. The function's value at the linear crossing
// says which.
vec2 refined_crossing(CrossedSide s) {
  float change = s.at_to - s.at_from, t = -s.at_from / change;
  float off = bound_at(mix(s.from, s.to, t));
  float slope = change + off * (1.0 - 2.0 * t) / max(t * (1.0 - t), 1e-3);
  if (slope * change < 0.25 * change * change) slope = change;
  return mix(s.from, s.to, clamp(t - off / slope, 0.0, 1.0));
}

// A point for the middle of an edge between two points of a bound. The area beside the edge's two straight pieces is to
// be that of a parabola, 2/3 of its height by its width, so that the point lies a third of the height beyond the bound.
#define FARTHEST_MIDDLE 0.5  // from the chord, by its length
vec2 middle_of_edge(vec2 a, vec2 b) {
  const float parabola_by_triangle = 4.0 / 3.0, step_by = 0.25;
  vec2 middle = 0.5 * (a + b), normal = vec2(a.y - b.y, b.x - a.x);
  float here = bound_at(middle), slope = (bound_at(middle + step_by * normal) - here) / step_by;
  float height = parabola_by_triangle * here;
  float by = abs(height) < FARTHEST_MIDDLE * abs(slope) ? -height / slope : 0.0;
  return clamp(middle + by * normal, vec2(0.0), vec2(1.0));
}

bool appends_middle(CutEdge edge, float fa, float fb) {
  return CURVED && edge.leaves.place >= 0 && fa > 0.0 && fb <= 0.0;
}

// Notes that a side crosses the bound; the crossing is about to be appended.
void note_crossing(inout CutEdge edge, vec2 a, vec2 b, float fa, float fb, int place) {
  CrossedSide crossed = CrossedSide(a, b, fa, fb, place);
  if (fa <= 0.0)
    edge.leaves = crossed;
  else
    edge.enters = crossed;
}

// Whether the polygon's list of corners begins within the edge: its middle is the last corner then.
bool wraps(CutEdge edge) { return CURVED && edge.leaves.place > edge.enters.place && edge.enters.place >= 0; }

void append_few(inout vec2 next[FEW_CORNERS], inout int count, int most, bool appends, vec2 corner) {
  for (int j = 0; j < FEW_CORNERS; ++j)
    if (j <= most) next[j] = appends && count == j ? corner : next[j];
  count += appends ? 1 : 0;
}

void cut_few() {
  vec2 next[FEW_CORNERS] = few;
  CutEdge edge = kNoEdge;
  int count = 0;
  vec2 a = few[0];
  float fa = bound_at(a);
  for (int k = 0; k < FEW_CORNERS - MORE_AFTER_CUT; ++k) {
    vec2 b = k + 1 >= corner_count ? few[0] : few[k + 1];
    float fb = bound_at(b);
    bool exists = k < corner_count, crosses = exists && (fa <= 0.0) != (fb <= 0.0);
    bool makes_middle = exists && appends_middle(edge, fa, fb);
    if (makes_middle) edge.middle_place = count;
    append_few(next, count, k + MORE_AFTER_CUT, exists && fa <= 0.0 || makes_middle, a);
    if (crosses) note_crossing(edge, a, b, fa, fb, count);
    append_few(next, count, k + MORE_AFTER_CUT, crosses, a + (b - a) * (fa / (fa - fb)));
    a = b;
    fa = fb;
  }
  if (wraps(edge)) edge.middle_place = count++;
  if (CURVED) {
    vec2 first = refined_crossing(edge.leaves), last = refined_crossing(edge.enters);
    vec2 middle = middle_of_edge(first, last);
    for (int j = 0; j < FEW_CORNERS; ++j) {
      if (j == edge.leaves.place) next[j] = first;
      if (j == edge.enters.place) next[j] = last;
      if (j == edge.middle_place) next[j] = middle;
    }
  }
  few = next;
  corner_count = min(count, FEW_CORNERS);
}

// Copies few[] to polygon[].
void keep_few() {
  if (!has_few) return;
  for (int k = 0; k < FEW_CORNERS; ++k) polygon[k] = few[k];
  has_few = false;
}

void end_cuts() {
  keep_few();
  if (first_corner != 0)
    for (int k = 0; k < corner_count; ++k) polygon[k] = polygon[first_corner + k];
  first_corner = 0;
}

// Each turn of the loop writes a corner, or the point at which the edge from it crosses, so that one place writes:
// lavapipe executes this for polygons of few corners, too.
void cut_many() {
  CutEdge edge = kNoEdge;
  int count = 0, to = first_corner == 0 ? MAX_CORNERS : 0;
  vec2 a = polygon[first_corner];
  float fa = bound_at(a);
  for (int k = 0; k < 2 * corner_count; ++k) {
    bool is_crossing = (k & 1) != 0;
    vec2 b = polygon[first_corner + (k / 2 + 1 == corner_count ? 0 : k / 2 + 1)];
    float fb = bound_at(b);
    bool makes_middle = !is_crossing && appends_middle(edge, fa, fb);
    bool crosses = is_crossing && (fa <= 0.0) != (fb <= 0.0);
    if (makes_middle) edge.middle_place = count;
    if (crosses) note_crossing(edge, a, b, fa, fb, count);
    bool appends = is_crossing ? crosses : fa <= 0.0 || makes_middle;
    if (appends && count < MAX_CORNERS) polygon[to + count++] = is_crossing ? a + (b - a) * (fa / (fa - fb)) : a;
    a = is_crossing ? b : a;
    fa = is_crossing ? fb : fa;
  }
  if (wraps(edge) && count < MAX_CORNERS) edge.middle_place = count++;
  int last_place = max(max(edge.leaves.place, edge.enters.place), edge.middle_place);
  if (CURVED && edge.middle_place >= 0 && last_place < count) {  // all of them have found room
    vec2 first = refined_crossing(edge.leaves), last = refined_crossing(edge.enters);
    polygon[to + edge.leaves.place] = first;
    polygon[to + edge.enters.place] = last;
    polygon[to + edge.middle_place] = middle_of_edge(first, last);
  }
  first_corner = to;
  corner_count = count;
}

void cut_by_bound() {
  if (corner_count > FEW_CORNERS - MORE_AFTER_CUT) keep_few();
  if (has_few)
    cut_few();
  else
    cut_many();
}
