// SPDX-License-Identifier: Apache-2.0
// The sums of tiles that several workgroups draw in parts: in fixed point, low and high words by pixel and channel.
#define TILE_SIDE 16
#define TILE_WORDS 1536u  // of a tile
#define SPLIT_SUMS BINS  // of `sums`: after the histogram

float frame_peak() { return max(uintBitsToFloat(counters[COUNT_PEAK]), 1e-30); }
float units_of(float peak) { return exp2(min(36.0 - ceil(log2(peak)), 120.0)); }  // a pixel value
