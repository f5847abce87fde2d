// SPDX-License-Identifier: Apache-2.0
// The counters of the shaders, and the dispatches whose size they decide: the words and bits of src/vulkan/counters.h.
// Included after buffers.glsl.
#define COUNT_POLYGONS 0
#define COUNT_CORNERS 1
#define COUNT_LISTED 2       // polygons in the lists of tiles
#define COUNT_WIDE 3         // polygons of many tiles
#define COUNT_TASKS 4        // parts of the lists of tiles
#define COUNT_SPLIT 5        // tiles whose lists have several parts
#define COUNT_OVERFLOWS 6    // bits, OVERFLOW_...
#define COUNT_MOST_LISTED 7  // the size that lists needed where theirs did not suffice
#define COUNT_PRIMITIVES 8   // `bundle`, `tiled`
#define COUNT_CUT 9          // cells, parts of cells or primitives that are cut
#define COUNT_OPEN 10        // `tiled`: primitives that nothing cuts
#define COUNT_BLOCKS 10      // `adaptive`: of 64 rays
#define COUNT_PEAK 11        // `adaptive`: bits of a float, the peak that errors are relative to
#define COUNT_SEARCHED 12    // `adaptive`: blocks of 256 rays for pupils and measures
#define OVERFLOW_RAYS 1u
#define OVERFLOW_POLYGONS 2u
#define OVERFLOW_CUT 4u
#define OVERFLOW_LISTS 8u
#define OVERFLOW_TURNS 16u  // a driver that bounds the turns of loops ended one before the end of a tile's list

#define DISPATCH_RAYS 0u
#define DISPATCH_OPEN 0u
#define DISPATCH_CUT 1u
#define DISPATCH_POLYGONS 2u
#define DISPATCH_WIDE 3u
#define DISPATCH_TILES 4u
#define DISPATCH_MERGED 5u  // `adaptive`: that lists merged cells
#define DISPATCH_ROW 1024u  // groups a row

// A group of a dispatch in rows, by its number.
uint linear_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

void set_dispatch(uint dispatch, uint group_count) {
  indirect[3u * dispatch] = min(group_count, DISPATCH_ROW);
  indirect[3u * dispatch + 1u] = (group_count + DISPATCH_ROW - 1u) / DISPATCH_ROW;
  indirect[3u * dispatch + 2u] = 1u;
}
