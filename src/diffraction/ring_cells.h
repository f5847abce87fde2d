// SPDX-License-Identifier: Apache-2.0
// The division of half a turn into cells at the radii of an octave: equal bins, and finer cells about directions in
// which the pattern is sharper than pixels, down to a sixteenth of a pixel.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Bins [first, end) with finer cells; end may continue past the last bin, to the first ones.
struct SharpBins {
  std::size_t first = 0, end = 0;
};

struct RingCells {
  std::size_t bins = 0;
  std::vector<double> edge;  // of the cells, in half turns: from 0 to 1; each bin's edges are among them
  std::vector<SharpBins> sharp;

  [[nodiscard]] std::size_t cells() const { return edge.size() - 1; }
};

// sharp: directions in half turns, 0 to 1. bins_per_px: at the octave's outer radius.
[[nodiscard]] RingCells cut_into_cells(std::size_t bins, std::span<const double> sharp, double bins_per_px);

// Adds zones of cells about the sharp bins, and marks the bins whose pixels are read from them: all within reach of a
// finer cell. rgb0: of all cells, [(row * cells + cell) * 4 + channel].
void add_sharp_zones(const RingCells& cells, std::span<const float> rgb0, std::size_t rows, StarburstOctave& octave);

// Mean densities over whole bins, [(row * bins + bin) * 4 + channel].
[[nodiscard]] std::vector<float> means_over_bins(const RingCells& cells, std::span<const float> rgb0, std::size_t rows);

}  // namespace contrejour::inline internal
