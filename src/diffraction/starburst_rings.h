// A starburst as rings about its centre: pixels' RGB by logarithm of the radius and by direction.
// A wavelength scales the pattern, which here is a shift from row to row; so a whole spectrum is one short sum down the
// rows, and no more than that is blurred. Real masks give patterns that are the same at p and -p: half a turn is kept.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace contrejour {

constexpr int kRowsPerOctave = 92;  // 4 nm at 550 nm

[[nodiscard]] inline double row_ratio(double rows) { return std::exp2(rows / kRowsPerOctave); }

// Radii from one to twice that, kRowsPerOctave + 1 rows, each of `angles` directions over half a turn: direction i is
// (i + 0.5) pi / angles from straight down, counter-clockwise.
struct StarburstOctave {
  std::size_t angles = 0;
  std::vector<float> rgb0;  // density per square pixel, [(row * angles + angle) * 4 + channel]; the fourth is 0

  [[nodiscard]] const float* at(std::size_t row, std::size_t angle) const {
    return rgb0.data() + (row * angles + angle) * 4;
  }
};

struct StarburstRings {
  double first_px = 0;  // radius of the first octave's first row; within it the density is that row's mean
  double radius_px = 0;  // nothing is kept beyond
  std::vector<StarburstOctave> octaves;
};

}  // namespace contrejour
