// SPDX-License-Identifier: Apache-2.0
// The middle of a starburst, where pixels are large compared with their distance from the centre: flux over rectangles
// as sums over the cells of the rings, integrated exactly along each direction from where it enters the rectangle to
// where it leaves it.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

// Corners from the centre, pixels, y up.
struct SquareAt {
  Vec2 low, high;
};

class NearField {
 public:
  // first_px: radius of the first octave's first row. weight: times the density at a radius, in pixels.
  NearField(std::span<const CellOctave> octaves, double first_px, const std::function<double(double)>& weight);

  struct Octave {
    double first_px = 0, end_px = 0;  // its first row's inner edge, 0 for the first octave's, and its last one's outer
    double first_row_px = 0;
    std::vector<double> edge;  // of cells, half turns
    std::vector<Vec2> along;  // the direction of each, y up
    std::vector<double> row_edge2;  // squares of rows' edges
    std::vector<std::array<double, 3>> below;  // [cell * (rows + 1) + row]: flux per radian within a row's inner edge
  };

  // The flux over a square; points beyond the octaves count as dark.
  [[nodiscard]] std::array<double, 3> flux(const SquareAt& square) const;

  // The data of flux(), for devices that compute it themselves (src/vulkan/shaders/starburst/near.comp).
  [[nodiscard]] std::span<const Octave> octaves() const { return octaves_; }

 private:
  struct Arc;

  struct Sector {
    std::size_t cell = 0;
    double from = 0, to = 0;  // half turns
    double sign = 1;  // of its directions: -1 for those half a turn on
  };

  static void add_arc(const Octave& octave, const Arc& arc, const SquareAt& square, std::array<double, 3>& sum);
  static void add_sector(const Octave& octave, const Sector& sector, const SquareAt& square,
                         std::array<double, 3>& sum);
  static void add_ray(const Octave& octave, std::size_t cell, double weight, double from_px, double to_px,
                      std::array<double, 3>& sum);

  std::vector<Octave> octaves_;
};

}  // namespace contrejour::inline internal
