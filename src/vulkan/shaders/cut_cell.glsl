// SPDX-License-Identifier: Apache-2.0
// The cells that cells.comp leaves to cut_cells.comp: the first corner's ray, the rays a side of its grid, the
// crossings of the stop, and whether the cell is open. In frames with stop patterns or dirt, the grid is in the high
// bits of the third word, and what dims the cell in those of the last.
#define CUT_GRID_SHIFT 2u
#define CUT_DIMS_SHIFT 1u
layout(std430, set = 0, binding = 17) buffer CutCells { uvec4 cut_cells[]; };
