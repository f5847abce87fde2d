// SPDX-License-Identifier: Apache-2.0
// Blocks of cells that are drawn at once. By block, merge.comp writes a mask to blocks[]: a bit for each quarter, and one for
// all of it.
#define BLOCK_CELLS 4u     // a side
#define BLOCKS_OF_RAYS 4u  // an item has fewer blocks than this times its blocks of 64 rays
#define WHOLE_BLOCK 16u

uint blocks_a_side(uint side) { return (side - 1u) / BLOCK_CELLS; }  // from the rays a side
