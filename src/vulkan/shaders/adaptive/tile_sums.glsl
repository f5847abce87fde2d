// SPDX-License-Identifier: Apache-2.0
// The sums of a tile, which are exact, so that the order of the lists changes no bit: those of small polygons and of
// planes are integers; the values of others are split into multiples of a coarse and of a fine unit.
#define PLANE_WORDS 18u
shared uint tile_sums[TILE_WORDS];
// The sums of polygons that cover the tile, then of those that cover each of its quarters: value at the tile's first
// pixel, slopes, by channel.
shared uint plane_sums[5u * PLANE_WORDS];
float fixed_units;  // a unit of pixel value
ivec2 tile_low;     // its first pixel

#define ROWS 8  // of a column
// The sums of an invocation's pixel; on processors of the pixels of its column.
vec3 coarse_sum[ROWS], fine_sum[ROWS];
float coarse_shift, fine_shift;  // 1.5 * 2^23 units: adding one rounds to a whole number of units

void begin_sums() {
  float peak = frame_peak();
  float coarse_unit = exp2(ceil(log2(peak)) - 8.0);  // sums of up to 65536 peaks are exact
  coarse_shift = coarse_unit * 12582912.0;
  fine_shift = coarse_shift * 6.103515625e-5;  // 2^-14: sums of the rests of 2048 polygons are exact
  fixed_units = units_of(peak);
}

void add_to_plane(uint at, float value) {
  uvec2 number = to_fixed(value);
  uint before = atomicAdd(plane_sums[at], number.x);
  uint high = number.y + (before > ~number.x ? 1u : 0u);
  if (high != 0u) atomicAdd(plane_sums[at + 1u], high);
}

void add_to_tile(uint at, float value) {
  uvec2 number = to_fixed(value);
  uint before = atomicAdd(tile_sums[at], number.x);
  uint high = number.y + (before > ~number.x ? 1u : 0u);
  if (high != 0u) atomicAdd(tile_sums[at + 1u], high);
}

void add(int row, float flux, vec3 gain) {
  precise vec3 value = flux * gain;
  precise vec3 coarse = (value + coarse_shift) - coarse_shift;
  precise vec3 rest = value - coarse;
  precise vec3 fine = (rest + fine_shift) - fine_shift;
  coarse_sum[row] += coarse;
  fine_sum[row] += fine;
}
