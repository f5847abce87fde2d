// SPDX-License-Identifier: Apache-2.0
// A starburst as rings about its centre: pixels' RGB by logarithm of the radius and by direction.
// A wavelength scales the pattern, which here is a shift from row to row; so a whole spectrum is one short sum along
// the rows, with no other blur. Real masks give patterns that are the same at p and -p: half a turn is kept. Directions
// are counted in half turns from straight down, counter-clockwise, 0 to 1.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

constexpr int kRowsPerOctave = 92;  // 4 nm at 550 nm
constexpr double kNear_px = 48.0;  // within, pixels are integrated exactly (near_field.h)

[[nodiscard]] inline double row_ratio(double rows) { return std::exp2(rows / kRowsPerOctave); }

// Directions about that of a spike, in cells finer than pixels where it is sharp.
struct SharpZone {
  std::size_t first_bin = 0;  // where its first cell begins; the zone may continue past the last bin, to the first ones
  std::vector<float> edge;  // of its cells, in bins from there
  std::vector<float> rgb0;  // mean density over each cell, [(row * cells + cell) * 4 + channel]; the fourth is 0

  [[nodiscard]] std::size_t cells() const { return edge.size() - 1; }
};

// Radii from one to twice its value, kRowsPerOctave + 1 rows, half a turn in equal bins.
struct StarburstOctave {
  std::size_t bins = 0;
  // Density per square pixel, averaged over the square pixel about each bin's beginning, and the last one's end:
  // [(row * (bins + 1) + bin) * 4 + channel]; the fourth is 0.
  std::vector<float> rgb0;
  std::vector<SharpZone> zones;
  std::vector<std::uint16_t> zone_of_bin;  // 1 more than the zone that pixels of the bin are read from; 0: from rgb0

  [[nodiscard]] const float* at(std::size_t row, std::size_t bin) const {
    return rgb0.data() + (row * (bins + 1) + bin) * 4;
  }
};

// The same without averages, in cells that may differ in size.
struct CellOctave {
  std::vector<double> edge;  // of the cells, in half turns: from 0 to 1
  std::vector<float> rgb0;  // mean density over each cell, [(row * cells + cell) * 4 + channel]

  [[nodiscard]] std::size_t cells() const { return edge.size() - 1; }
  [[nodiscard]] const float* at(std::size_t row, std::size_t cell) const {
    return rgb0.data() + (row * cells() + cell) * 4;
  }
};

class NearField;

struct StarburstRings {
  double first_px = 0;  // radius of the first octave's first row; within it the density is that row's
  double radius_px = 0;  // nothing is kept beyond
  std::vector<StarburstOctave> octaves;  // those within kNear_px have no means over pixels
  std::vector<CellOctave> near_cells;  // the first octaves, as far as pixels within kNear_px reach
  std::shared_ptr<const NearField> near;

  [[nodiscard]] std::size_t bytes() const {
    std::size_t floats = 0;
    for (const StarburstOctave& octave : octaves) {
      floats += octave.rgb0.size();
      for (const SharpZone& zone : octave.zones) floats += zone.rgb0.size();
    }
    for (const CellOctave& octave : near_cells) floats += octave.rgb0.size();
    // The near field has the near cells' values once more, as doubles and without the fourth.
    for (const CellOctave& octave : near_cells) floats += octave.rgb0.size() * 3 / 2;
    return floats * sizeof(float);
  }
};

}  // namespace contrejour::inline internal
