// SPDX-License-Identifier: Apache-2.0
// The irradiance of the cells around a ray, which share it.
// CellRaster::find_irradiance() and PrimitiveBuilder::find_irradiance(), which are the same: the flux of the cells
// around a vertex over their area, hullin2011 4.1 and 4.3. Cells beyond the border count as those inside it.
#ifndef SMOOTH_RATIO
#define SMOOTH_RATIO 1.5
#endif

float shared_irradiance(uint column, uint row, uint rays_a_side) {
  int last = int(rays_a_side) - 1, ix = int(column), iy = int(row);
  // The rays around; those of a cell beyond the border are those of the cell inside it.
  vec4 around[9];
  for (int j = 0; j < 9; ++j)
    around[j] = ray_of(ray_at(uint(clamp(ix + j % 3 - 1, 0, last)), uint(clamp(iy + j / 3 - 1, 0, last))));
  float low = FAILED, high = -FAILED, sum = 0.0;
  for (int j = 0; j < 4; ++j) {
    int cx = ix == 0 ? 1 : ix == last ? 0 : j % 2, cy = iy == 0 ? 1 : iy == last ? 0 : j / 2;
    int first = 3 * cy + cx;
    vec4 a = around[first], b = around[first + 1], c = around[first + 4], d = around[first + 3];
    bool fails = failed(a) || failed(b) || failed(c) || failed(d);
    vec2 ac = c.xy - a.xy, bd = d.xy - b.xy;
    float area = fails ? 0.0 : 0.5 * (ac.x * bd.y - ac.y * bd.x);
    low = min(low, area);
    high = max(high, area);
    sum += area;
  }
  float smallest = min(abs(low), abs(high)), largest = max(abs(low), abs(high));
  bool is_smooth = low * high > 0.0 && largest < SMOOTH_RATIO * smallest;
  return is_smooth ? 4.0 * around[4].z / abs(sum) : 0.0;
}
