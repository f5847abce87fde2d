// SPDX-License-Identifier: Apache-2.0
// Distributes the error that the frame may make among its items, in one workgroup. An item of n cells a side makes the
// squared error c / n^4, and costs n^2: the sum of the costs is smallest, for a given sum of errors, where an item's
// error is in proportion to the cube root of c.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 256) in;
#include "common.glsl"
#include "merged.glsl"

#define MOST_CELLS 1024.0
#define MOST_CELLS_OF_SPOTS 64.0
#define LEAST_CELLS 3.0
#define MOST_FOR_FLUX 24.0
#define SPOT_PX 8.0  // images of fewer pixels are spots; it was chosen
#define LARGEST_MERGED 4.0e-4    // squared displacement by the ghost's area: colours are kept to a fiftieth of its size
#define SHARP_SHARE 0.5            // of the error: items drawn with the sharp iris in place of their stop patterns
#define MERGED_SHARE 0.25         // of an item's error: what drawing it in another wavelength may cost

shared float numbers[256];
shared uint counts[256];
shared uint chosen, faintest;

// The lower end of the bin from which on the brighter samples are as many as are wanted.
float find_peak() {
  uint t = gl_LocalInvocationIndex, wanted = wanted_parts();
  uint own[4];
  uint sum = 0u;
  for (uint k = 0u; k < 4u; ++k) {
    own[k] = sums[4u * t + k];
    sum += min(own[k], wanted);
  }
  counts[t] = sum;
  if (t == 0u) chosen = 0u;
  barrier();
  for (uint reach = 1u; reach < 256u; reach *= 2u) {  // sums from the end
    uint other = t + reach < 256u ? counts[t + reach] : 0u;
    barrier();
    counts[t] = min(counts[t] + other, wanted);
    barrier();
  }
  uint above = t < 255u ? counts[t + 1u] : 0u;
  if (above < wanted) {
    for (uint k = 4u; k-- > 0u;) {
      above += min(own[k], wanted);
      if (above >= wanted) {
        chosen = 4u * t + k;
        break;
      }
    }
  }
  barrier();
  // If less than a thousandth of the frame is lit, the faintest light is the peak.
  if (chosen == 0u) {
    for (uint k = 0u; k < 4u; ++k)
      if (own[k] != 0u) atomicMax(faintest, BINS - (4u * t + k));
    barrier();
    return faintest == 0u ? 0.0 : uintBitsToFloat((BINS - faintest) << BIN_SHIFT);
  }
  return uintBitsToFloat(chosen << BIN_SHIFT);
}

float sum_of(float number) {
  numbers[gl_LocalInvocationIndex] = number;
  barrier();
  for (uint half_count = 128u; half_count > 0u; half_count /= 2u) {
    if (gl_LocalInvocationIndex < half_count)
      numbers[gl_LocalInvocationIndex] += numbers[gl_LocalInvocationIndex + half_count];
    barrier();
  }
  float sum = numbers[0];
  barrier();
  return sum;
}

// An item's light within the frame.
float light_of(uint item) {
  vec3 gain = abs(item_gain(item));
  return state(item, STATE_FLUX) * max(max(gain.x, gain.y), gain.z);
}

// The light of all items. As if it fell on one pixel, it is the peak where all of it is in spots so small that the
// histogram counts nothing.
float light_of_all() {
  float light = 0.0;
  for (uint item = gl_LocalInvocationIndex; item < p.item_count; item += 256u) light += light_of(item);
  return sum_of(light);
}

// The cells a side with which the frame has the right flux, though a ghost may be too dim to need them. An item of n
// cells is off by about 1 / n^2 of its flux and costs n^2: the sum of the costs is smallest, for a given sum of errors,
// where n^4 is in proportion to the flux.
float cells_for_flux(float light, float all_light, float extent_px) {
  float usual = extent_px < SPOT_PX ? p.spot_cells : float(p.usual_cells);
  float typical = usual * sqrt(sqrt(float(p.item_count) * light / max(all_light, 1e-37)));
  return clamp(ceil(typical), LEAST_CELLS, MOST_FOR_FLUX);
}

float cube_root(float x) { return x > 0.0 ? pow(x, 1.0 / 3.0) : 0.0; }

// The cells a side for half of the allowed error.
float side_for(float error, float allowed) {
  return float(COARSE_CELLS) * sqrt(sqrt(2.0 * error / max(allowed, 1e-37)));
}

// The cells a side, and the parts a side of a cell at an edge: edges may be finer than the grid. least: of the cells.
uvec2 cells_for(uint item, float allowed_by_root, float least) {
  if (!(state(item, STATE_FLUX) > 0.0)) return uvec2(0u);
  if (!(allowed_by_root > 0.0)) return uvec2(COARSE_CELLS, 1u);
  float allowed = allowed_by_root * cube_root(squared_error_of(item));
  float edges = side_for(state(item, STATE_EDGE_ERROR), allowed);
  float cells = max(side_for(state(item, STATE_ERROR), allowed), edges / float(MOST_EDGE_PARTS));
  // Cells smaller than a third of a pixel show nothing more, but the light of spots of few pixels is that of their folds.
  cells = min(cells, clamp(3.0 * state(item, STATE_EXTENT), MOST_CELLS_OF_SPOTS, MOST_CELLS));
  // Cells for the flux made fringes worse (docs/gpu.md); the cause is not known.
  if (item_pattern(item) != 0u) least = float(p.usual_cells);
  cells = max(ceil(cells), least);
  return uvec2(cells, clamp(ceil(edges / cells), 1.0, float(MOST_EDGE_PARTS)));
}

void set_gains(uint item, vec3 gain, mat2x3 slopes) {
  uint word = STATE_WORDS * item;
  for (uint c = 0u; c < 3u; ++c) {
    states[word + STATE_GAIN + c] = gain[c];
    states[word + STATE_SLOPES + c] = slopes[0][c];
    states[word + STATE_SLOPES + 3u + c] = slopes[1][c];
  }
}

// Draws items by the middle one of their group where that is within the error and keeps the colours.
void merge(uint group, float allowed_by_root, float allowed_sharp, float all_light) {
  uint first = group_word(group, 0u), count = group_word(group, 1u), middle = group_word(group, 2u);
  float light = 0.0;
  for (uint item = first; item < first + count; ++item) light += light_of(item);
  vec3 gain = item_gain(middle);
  mat2x3 slopes = item_gain_slopes(middle);
  vec4 box = final_box(group);
  for (uint item = first; item < first + count; ++item) {
    uint word = STATE_WORDS * item;
    float least = cells_for_flux(item == middle ? light : light_of(item), all_light, state(item, STATE_EXTENT));
    uvec2 cells_and_parts = cells_for(item, allowed_by_root, least);
    uint cells = cells_and_parts.x;
    float allowed = MERGED_SHARE * allowed_by_root * cube_root(squared_error_of(item));
    if (item != middle && cells > 0u && state(middle, STATE_FLUX) > 0.0 && state(item, STATE_MERGED_ERROR) <= allowed &&
        state(item, STATE_DISPLACEMENT) <= LARGEST_MERGED) {
      float ratio = state(item, STATE_FLUX) / state(middle, STATE_FLUX);
      mat2x3 own = item_gain_slopes(item);
      gain += (item_gain(item) + own * (item_middle(middle) - item_middle(item))) * ratio;
      slopes += own * ratio;
      cells = 0u;
    }
    states[word + STATE_CELLS] = uintBitsToFloat(cells);
    for (uint k = 0u; k < 4u; ++k) states[word + STATE_BOX + k] = box[k];
    states[word + STATE_PARTS] = uintBitsToFloat(cells_and_parts.y);
    set_gains(item, item_gain(item), item_gain_slopes(item));
    uint pattern = item_pattern(item);
    if (pattern != 0u && state(item, STATE_SHARP_ERROR) <= allowed_sharp) pattern = 0u;
    states[word + STATE_PATTERN] = uintBitsToFloat(pattern);
  }
  set_gains(middle, gain, slopes);
}

uint blocks_of(uint item) {
  uint cells = cells_of(item);
  return cells == 0u ? 0u : ((cells + 1u) * (cells + 1u) + 63u) / 64u;
}

// The sum of the blocks of the items before each.
uint number_blocks() {
  uint t = gl_LocalInvocationIndex, before = 0u;
  for (uint first = 0u; first < p.item_count; first += 256u) {
    uint item = first + t;
    counts[t] = item < p.item_count ? blocks_of(item) : 0u;
    uint own = counts[t];
    barrier();
    for (uint reach = 1u; reach < 256u; reach *= 2u) {
      uint other = t >= reach ? counts[t - reach] : 0u;
      barrier();
      counts[t] += other;
      barrier();
    }
    if (item < p.item_count) states[STATE_WORDS * item + STATE_OFFSET] = uintBitsToFloat(before + counts[t] - own);
    before += counts[255];
    barrier();
  }
  return before;
}

void main() {
  uint t = gl_LocalInvocationIndex;
  if (t == 0u) faintest = 0u;
  barrier();
  float found_peak = find_peak(), all_light = light_of_all();
  float peak = max(found_peak > 0.0 ? found_peak : all_light, p.least_peak);
  float roots = 0.0;
  for (uint item = t; item < p.item_count; item += 256u) roots += cube_root(squared_error_of(item));
  float all_roots = sum_of(roots);
  float allowed_by_root = all_roots > 0.0 ? p.budget * peak * peak / all_roots : 0.0;
  float allowed_sharp = SHARP_SHARE * p.budget * peak * peak / float(p.item_count);
  for (uint group = t; group < p.group_count; group += 256u) merge(group, allowed_by_root, allowed_sharp, all_light);
  memoryBarrierBuffer();
  barrier();
  uint blocks = number_blocks();
  if (t != 0u) return;
  states[STATE_WORDS * p.item_count + STATE_OFFSET] = uintBitsToFloat(blocks);
  bool fits = 64u * blocks <= p.ray_capacity;
  if (!fits) counters[COUNT_OVERFLOWS] = OVERFLOW_RAYS;
  counters[COUNT_BLOCKS] = blocks;
  counters[COUNT_PEAK] = floatBitsToUint(peak);
  set_dispatch(DISPATCH_RAYS, fits ? blocks : 0u);
  set_dispatch(DISPATCH_MERGED, fits ? (blocks * BLOCKS_OF_RAYS + 63u) / 64u : 0u);
}
