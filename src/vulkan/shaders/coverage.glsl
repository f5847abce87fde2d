// SPDX-License-Identifier: Apache-2.0
// The exact part of a pixel that a polygon covers, as the sum of signed areas beside its edges, or beside one edge.

// The integral over an edge's height, within a pixel's row, of the part of the pixel that lies right of the edge. The
// pixel is the unit square; positive where the edge runs to larger y.
float area_right_of(vec2 a, vec2 b) {
  float y0 = clamp(min(a.y, b.y), 0.0, 1.0), y1 = clamp(max(a.y, b.y), 0.0, 1.0);
  if (!(y1 > y0)) return 0.0;
  vec2 low = a.y < b.y ? a : b, high = a.y < b.y ? b : a;
  float slope = (high.x - low.x) / (high.y - low.y);
  float xa = low.x + slope * (y0 - low.y), xb = low.x + slope * (y1 - low.y);
  float x0 = min(xa, xb), x1 = max(xa, xb);
  float mean;
  if (x1 <= 0.0) {
    mean = 1.0;
  } else if (x0 >= 1.0) {
    mean = 0.0;
  } else if (x0 >= 0.0 && x1 <= 1.0) {
    mean = 1.0 - 0.5 * (x0 + x1);
  } else {
    float left = max(x0, 0.0), right = min(x1, 1.0);
    mean = ((left - x0) + (right - left) * (1.0 - 0.5 * (left + right))) / (x1 - x0);
  }
  return (a.y < b.y ? mean : -mean) * (y1 - y0);
}

// The part of a pixel on the positive side of an edge that crosses it.
float half_plane(vec2 slope, float at_middle) {
  float longer = max(abs(slope.x), abs(slope.y)), shorter = min(abs(slope.x), abs(slope.y)), off = abs(at_middle);
  float rest = 0.5 * (longer + shorter) - off;
  float part = off <= 0.5 * (longer - shorter) ? 0.5 + off / longer : 1.0 - rest * rest / (2.0 * longer * shorter);
  return at_middle >= 0.0 ? part : 1.0 - part;
}
