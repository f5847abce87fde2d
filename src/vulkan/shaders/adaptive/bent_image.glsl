// SPDX-License-Identifier: Apache-2.0
// The density of a cell whose image has sides that bend, though they are drawn as straight lines. Included after
// ../cell.glsl.

// Whether a cell has a gradient. Small cells of caustics have none, as theirs are steep; those of smooth light need one, or
// they show as steps of a percent. irradiance: at the corners.
bool is_shaded(float area, vec4 irradiance) {
  vec2 low = min(irradiance.xy, irradiance.zw), high = max(irradiance.xy, irradiance.zw);
  bool is_smooth = max(high.x, high.y) <= 2.0 * min(low.x, low.y);
  return abs(area) >= (is_smooth ? 1.0 : SHADED_CELL_PX);
}

// The area between the sides of an image and straight lines in their place, and its first moment. The area has the sign of
// the image's.
struct Bulges {
  float area;
  vec2 moment;
};

// The mean distance of a side from the straight line between its ends, if it is a parabola with this second difference:
// the mean of t (1 - t) / 2 is 1 / 12.
vec2 mean_distance_of(vec2 bend) { return -bend / 12.0; }

void add_bulge(inout Bulges bulges, vec2 from, vec2 to, vec2 mean_distance) {
  float area = cross2(mean_distance, to - from);
  bulges.area += area;
  bulges.moment += area * 0.5 * (from + to);
}

// area, middle: of what straight lines enclose. The density is the mean over the image itself, at the image's centroid:
// with the mean over what is drawn, a ghost larger than the frame would be too dim in all of it. An image that differs
// by more than half is about to fold, and counts as what is drawn.
#define LARGEST_BULGE 0.5
Density density_of(float flux, float area, vec2 middle, Bulges bulges, vec2 gradient) {
  float larger_by = bulges.area / area;
  if (abs(larger_by) <= LARGEST_BULGE) {
    middle = (middle + bulges.moment / area) / (1.0 + larger_by);
    area *= 1.0 + larger_by;
  }
  float value = flux / abs(area);
  return Density(middle, value, gradient * value);
}
