// SPDX-License-Identifier: Apache-2.0
// The cells that cells.comp leaves to cut_cells.comp: the first corner's ray, the rays a side of its grid, the
// crossings of the stop, and whether the cell is open.
layout(std430, set = 0, binding = 20) buffer CutCells { uvec4 cut_cells[]; };
