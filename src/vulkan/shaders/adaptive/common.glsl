// SPDX-License-Identifier: Apache-2.0
// The buffers and the parameters of the shaders of `adaptive`, which draw a frame in a fixed number of dispatches: the
// device itself decides how finely each ghost is drawn. An item is a ghost of a light at one wavelength; a group is all
// items of a ghost and a light. Sizes and layouts are those of src/vulkan/adaptive_layout.h.
#include "../buffers.glsl"
#include "../counts.glsl"
#include "../stop/tables.glsl"

#define ITEM_WORDS 24u
#define STATE_WORDS 24u
#define LEVELS 7u  // of the search for the pupil, with three scans

// By group and level: the box that is searched, lower corner and size, mm from the point of the start; and the bounds
// of its cells through which light passes, then of those through which it may pass, which count at the first level, and
// later where there are no others: each the largest of (cells - column, cells - row, column + 1, row + 1).
layout(std430, set = 0, binding = 15) buffer Found { uint found[]; };
layout(std430, set = 0, binding = 16) buffer States { float states[]; };  // by item, and what follows the last one
layout(std430, set = 0, binding = 17) buffer CutCells { uvec2 cut_cells[]; };  // item and cell
layout(set = 0, binding = 39) uniform usamplerBuffer item_texels;   // six an item, then one a group
layout(set = 0, binding = 40) uniform samplerBuffer start_texels;   // four a light
layout(set = 0, binding = 41) uniform samplerBuffer state_texels;   // six an item
layout(set = 0, binding = 42) uniform usamplerBuffer found_texels;  // three a group and level, of levels that are done
layout(set = 0, binding = 43) uniform usamplerBuffer cut_texels;

layout(push_constant) uniform Parameters {
  uint item_count, group_count, level, flags;
  uint bound_count;
  int width, height;
  uint ray_capacity, large_capacity, corner_capacity, cut_capacity;
  float budget;         // squared error of the frame's samples, in peaks
  float least_peak;     // that errors are relative to
  float front_gap;      // from the entrance plane to that of dirt on the front, mm
  uint picture;         // as the iris: its pattern's number, of which the next one is its distances; 0: none
  int small_px;         // the most pixels of a polygon in a tile that one invocation draws by itself
  float merge_error;    // of pixels, in peaks, that a plane over several cells may make
  uint usual_cells;     // a side of an item of the mean flux; of one with fringes, at least
  float spot_cells;     // likewise, for images of few pixels
  uint window_blocks;   // a side, of 16 x 16 rays, in which the first level searches the window for pupils
}
p;

#define FLAG_SYMMETRIC 256u  // all ghosts have axial symmetry

// A part of a cut cell, in cut_cells[].y: the cell's first ray in its grid, the part, the parts a side less 1.
#define CUT_CELL_MASK 0x1fffffu
#define CUT_PART_SHIFT 21u
#define CUT_PARTS_SHIFT 25u
#define MOST_CUT_PARTS 4u
#define MOST_EDGE_PARTS 2u  // where an edge cuts it

uint item_word(uint item, uint k) { return texelFetch(item_texels, int(ITEM_WORDS / 4u * item + (k >> 2u)))[k & 3u]; }
float item_float(uint item, uint k) { return uintBitsToFloat(item_word(item, k)); }
uint group_of(uint item) { return item_word(item, 3u); }
uint crossings_of(uint item) { return item_word(item, 4u); }
float item_irradiance(uint item) { return item_float(item, 5u); }  // flux of a mm^2 of the entrance plane
vec3 item_gain(uint item) { return vec3(item_float(item, 6u), item_float(item, 7u), item_float(item, 8u)); }
// The change of the gains with the place in the window, by mm, and where they are item_gain().
mat2x3 item_gain_slopes(uint item) {
  return mat2x3(item_float(item, 16u), item_float(item, 17u), item_float(item, 18u), item_float(item, 19u),
                item_float(item, 20u), item_float(item, 21u));
}
vec2 item_middle(uint item) { return vec2(item_float(item, 22u), item_float(item, 23u)); }
vec2 item_window(uint item) { return vec2(item_float(item, 9u), item_float(item, 10u)); }  // its size, mm

// The code for stop patterns is left out of frames without them: lavapipe executes both sides of branches.
layout(constant_id = 5) const bool HAS_PATTERNS = true;
uint item_pattern(uint item) { return HAS_PATTERNS ? item_word(item, 14u) : 0u; }  // from 1 on; 0: the iris is sharp

// Words of a group: its first item, their number, the item in whose wavelength the pupil is searched.
uint group_word(uint group, uint k) { return texelFetch(item_texels, int(ITEM_WORDS / 4u * p.item_count + group))[k]; }

// A histogram of the frame's values, in sums[]: bins of a quarter of an octave, in sixteenths of a pixel and channel.
#define BINS 1024u
#define BIN_SHIFT 21u  // of a float's bits
#define PIXEL_PARTS 16.0
#define BRIGHTER_THAN_PEAK 0.001  // the part of the samples that exceed the peak (metrics.h)
uint wanted_parts() { return max(uint(BRIGHTER_THAN_PEAK * 3.0 * PIXEL_PARTS * float(p.width) * float(p.height)), 1u); }

// An item's state: error of a grid of COARSE_CELLS a side between its edges, of the edges, and of drawing it in another
// one's wavelength, all squared and summed over the pixels; its flux within the frame; the squared displacement from the
// other, relative to its area; the cells a side, and the parts a side of a cell at an edge; its gains with those of the
// items that are drawn by it; the squared error of drawing its stop pattern as the sharp iris, and the pattern that is
// drawn; the box in which its rays are traced; its first block of 64 rays, which is their number after the last item.
#define STATE_ERROR 0u
#define STATE_MERGED_ERROR 1u
#define STATE_FLUX 2u
#define STATE_DISPLACEMENT 3u
#define STATE_CELLS 4u
#define STATE_GAIN 5u
#define STATE_EDGE_ERROR 8u
#define STATE_EXTENT 9u  // of the image, pixels
#define STATE_PARTS 10u
#define STATE_SHARP_ERROR 11u
#define STATE_PATTERN 12u
#define STATE_BOX 13u     // lower corner, size
#define STATE_SLOPES 17u  // of the gains: by x, then by y
#define STATE_OFFSET 23u
#define COARSE_CELLS 15u
#ifdef READ_TEXELS
float state(uint item, uint k) { return texelFetch(state_texels, int(STATE_WORDS / 4u * item + (k >> 2u)))[k & 3u]; }
#else
float state(uint item, uint k) { return states[STATE_WORDS * item + k]; }
#endif
float squared_error_of(uint item) { return state(item, STATE_ERROR) + state(item, STATE_EDGE_ERROR); }
uint offset_of(uint item) { return floatBitsToUint(state(item, STATE_OFFSET)); }
uint cells_of(uint item) { return floatBitsToUint(state(item, STATE_CELLS)); }
vec4 state_box(uint item) {
  return vec4(state(item, STATE_BOX), state(item, STATE_BOX + 1u), state(item, STATE_BOX + 2u),
              state(item, STATE_BOX + 3u));
}
uint pattern_of(uint item) { return HAS_PATTERNS ? floatBitsToUint(state(item, STATE_PATTERN)) : 0u; }
// The gains at a place in the window, mm.
vec3 state_gain(uint item, vec2 at) {
  vec2 by = at - item_middle(item);
  vec3 gain;
  for (uint c = 0u; c < 3u; ++c) {
    vec2 slopes = vec2(state(item, STATE_SLOPES + c), state(item, STATE_SLOPES + 3u + c));
    gain[c] = state(item, STATE_GAIN + c) + dot(slopes, by);
  }
  return gain;
}

#define LAST_LEVEL 3u  // of the search
#define ALL_ITEMS_LEVEL 2u  // from which on it is at the wavelengths of all items, whose pupils may lie beside each other
// A further level follows the first one, and does nothing if that found light. It scans the meridian more finely, and at
// the group's first and last wavelengths. Its boxes and bounds are three, for each of these scans.
#define SCAN_LEVEL 4u
#define FINE_SCANS 2u  // workgroups that scan at the middle wavelength
bool searches_window(uint level) { return level == 0u || level >= SCAN_LEVEL; }
// Levels whose boxes lie along the plane of the light and the axis; the halves of a box by its second side mirror each
// other. Later boxes, and all without axial symmetry, lie along the frame: tiles are filled faster by cells that do.
bool is_mirrored(uint level) {
  return (p.flags & FLAG_SYMMETRIC) != 0u && (level < ALL_ITEMS_LEVEL || level >= SCAN_LEVEL);
}
// The direction of the plane of the item's light and the axis: the first side of a box that lies along it.
vec2 meridian_of(uint item) { return texelFetch(start_texels, int(4u * item_word(item, 11u) + 2u)).xy; }
vec2 in_lens_frame(vec2 meridian, vec2 along_it) {
  return meridian * along_it.x + vec2(-meridian.y, meridian.x) * along_it.y;
}
// The bounds along the frame of a box along a meridian.
vec4 bounds_along_frame(vec2 meridian, vec4 box) {
  vec2 x = in_lens_frame(meridian, vec2(box.z, 0.0)), y = in_lens_frame(meridian, vec2(0.0, box.w));
  vec2 middle = in_lens_frame(meridian, box.xy + 0.5 * box.zw), size = abs(x) + abs(y);
  return vec4(middle - 0.5 * size, size);
}

// The workgroups by the sides of what is searched, which is the upper half of a box that is mirrored.
uvec2 blocks_by_sides(uint level) {
  uint a_side = searches_window(level) ? p.window_blocks : level == 1u && (p.flags & FLAG_SYMMETRIC) == 0u ? 2u : 1u;
  return uvec2(a_side, is_mirrored(level) ? (a_side + 1u) / 2u : a_side);
}
uint search_blocks(uint level) {
  if (level == SCAN_LEVEL) return FINE_SCANS + 2u;
  uvec2 blocks = blocks_by_sides(level);
  return blocks.x * blocks.y + (level == 0u || (level == 1u && is_mirrored(level)) ? 1u : 0u);  // a scan
}
uvec2 cells_of_level(uint level) { return COARSE_CELLS * blocks_by_sides(level); }
vec4 searched_part(uint level, vec4 box) {
  float half_width = 0.5 * box.w;
  return is_mirrored(level) ? vec4(box.x, box.y + half_width, box.z, half_width) : box;
}

#define LEVEL_WORDS 12u
// A group's level among all groups' levels; what was found at it, once the level is done.
uint number_of_level(uint group, uint level) { return group * LEVELS + level; }
vec4 box_at(uint number) { return uintBitsToFloat(texelFetch(found_texels, int(3u * number))); }
uvec4 cells_that_pass(uint number) { return texelFetch(found_texels, int(3u * number + 1u)); }
uvec4 cells_that_may_pass(uint number) { return texelFetch(found_texels, int(3u * number + 2u)); }

bool passes_at_level(uint group, uint level) { return cells_that_pass(number_of_level(group, level)).z > 0u; }
// The level that found light first, or the scan.
uint first_level(uint group) {
  for (uint level = SCAN_LEVEL; level < LEVELS; ++level)
    if (!passes_at_level(group, 0u) && passes_at_level(group, level)) return level;
  return 0u;
}
uint item_of_first_level(uint group, uint level) {
  uint first = group_word(group, 0u);
  return level == 0u || level == SCAN_LEVEL ? group_word(group, 2u)
         : level == SCAN_LEVEL + 1u         ? first
                                            : first + group_word(group, 1u) - 1u;
}

// The number of cells within bounds.
uint extent_of(uvec4 f, uvec2 cells) { return f.z == 0u ? 0u : (f.x + f.z - cells.x) * (f.y + f.w - cells.y); }

// Bounds of light that reaches the sides of the box that was searched are moved outwards, since the box may have cut off
// some of it: boxes come from the cells of the first level. A search that was over, or whose cells all pass, says nothing.
vec4 beyond_cuts(vec4 bounds, uvec4 passes, uvec2 cells, vec2 window, bool is_mirrored) {
  if (passes == cells.xyxy) return bounds;
  vec2 low = bounds.xy, high = bounds.xy + bounds.zw;
  bvec2 low_cut = bvec2(passes.x == cells.x, is_mirrored ? passes.w == cells.y : passes.y == cells.y);
  vec2 farther = min(0.5 * bounds.zw, 2.0 * window / float(COARSE_CELLS * p.window_blocks));
  for (uint k = 0u; k < 2u; ++k) {
    if (low_cut[k] && low[k] > 0.0) low[k] -= farther[k];
    if (passes[k + 2u] == cells[k] && high[k] < window[k]) high[k] += farther[k];
  }
  return vec4(low, high - low);
}

#define MOST_FARTHER 4u  // the largest growth of a box by cells that may pass
// The box of a level of the search after the first ones, from the bounds that the level before found.
vec4 box_of_level(uint group, uint level) {
  uint before = number_of_level(group, level == 1u ? first_level(group) : level - 1u);
  vec4 box = box_at(before);
  uvec2 cells = cells_of_level(level - 1u);
  uvec4 passes = cells_that_pass(before), may_pass = cells_that_may_pass(before);
  uvec4 f = passes.z > 0u ? passes : may_pass;
  // Between the rays of the first level there may be other parts of a pupil than those that rays have found. They count
  // if the next level resolves what was found in the larger box.
  uvec4 both = max(passes, may_pass);
  if (level == 1u && extent_of(both, cells) <= 9u * extent_of(passes, cells)) f = both;
  // Later, cells that may pass about those that do are left out. Others have parts of a pupil thinner than a cell, and
  // count in the same way, but for frames with fringes, whose faint ends would enlarge the boxes.
  if (!HAS_PATTERNS && level > ALL_ITEMS_LEVEL && passes.z > 0u) {
    uvec4 farther = passes;
    for (uint k = 0u; k < 4u; ++k)
      if (may_pass[k] > passes[k] + 1u) farther[k] = may_pass[k];
    if (extent_of(farther, cells) <= MOST_FARTHER * extent_of(passes, cells)) f = farther;
  }
  if (f.z == 0u) return vec4(box.xy, 0.0, 0.0);
  vec4 searched = searched_part(level - 1u, box);
  vec2 step_mm = searched.zw / vec2(cells);
  vec2 low = searched.xy + vec2(cells - f.xy) * step_mm, high = searched.xy + vec2(f.zw) * step_mm;
  if (is_mirrored(level - 1u)) low.y = 2.0 * searched.y - high.y;
  vec4 narrowed = vec4(low, high - low);
  // The last level's box has no margin, unless the search at the level before was over.
  if (level > 1u && (level <= LAST_LEVEL || box == box_at(before - 1u)))
    narrowed = beyond_cuts(narrowed, passes, cells, item_window(group_word(group, 0u)), is_mirrored(level - 1u));
  if (is_mirrored(level - 1u) && !is_mirrored(level))
    narrowed = bounds_along_frame(meridian_of(group_word(group, 0u)), narrowed);
  const float margin = 0.25;
  if (level == ALL_ITEMS_LEVEL) narrowed = vec4(narrowed.xy - margin * narrowed.zw, (1.0 + 2.0 * margin) * narrowed.zw);
  return narrowed;
}

// The box in which a group's rays are traced. Later it is in the state of each item: state_box().
vec4 final_box(uint group) {
  const float margin = 0.04;
  vec4 box = box_of_level(group, LAST_LEVEL + 1u);
  return vec4(box.xy - margin * box.zw, (1.0 + 2.0 * margin) * box.zw);
}

// The item whose rays are in a block.
uint item_of_block(uint block) {
  uint low = 0u, high = p.item_count;
  while (low + 1u < high) {
    uint middle = (low + high) / 2u;
    if (offset_of(middle) <= block)
      low = middle;
    else
      high = middle;
  }
  return low;
}

