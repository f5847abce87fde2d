// SPDX-License-Identifier: Apache-2.0
// The exact fraction of each sample of a square grid that a polygon covers, however thin it is: each edge adds the
// signed area to its right, as in font rasterisers.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

class PolygonCover {
 public:
  explicit PolygonCover(int side);

  // Calls visit(sample, fraction) for the samples [row * side + column] that the polygon overlaps. corners: in samples,
  // x to the right and y down, (0, 0) the top left corner of the grid; either orientation, no crossings.
  template <class Visit>
  void for_each(std::span<const Vec2> corners, const Visit& visit) {
    double sign = 0.0;
    for (std::size_t k = 0; k < corners.size(); ++k) sign += cross(corners[k], corners[(k + 1) % corners.size()]);
    for (std::size_t k = 0; k < corners.size(); ++k) add_edge(corners[k], corners[(k + 1) % corners.size()]);
    for (int row = first_row_; row <= last_row_; ++row) {
      Touched& touched = touched_[static_cast<std::size_t>(row)];
      double area = 0.0;
      for (int column = touched.first; column <= touched.last; ++column) {
        double& change = change_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)];
        area += change;
        change = 0.0;
        const double covered = sign > 0.0 ? area : -area;
        if (column < side_ && covered > kNothing)
          visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(column),
                covered < 1.0 ? covered : 1.0);
      }
      touched = {};
    }
    first_row_ = side_;
    last_row_ = -1;
  }

 private:
  static constexpr double kNothing = 1e-12;
  struct Touched {
    int first = 1 << 30, last = -1;
  };

  void add_edge(Vec2 a, Vec2 b);
  void add_in_row(int row, Vec2 a, Vec2 b);
  void add(int row, int column, double area);

  int side_;
  std::size_t width_;  // of a row of changes: two more than samples
  std::vector<double> change_;  // change of the covered area from sample to sample
  std::vector<Touched> touched_;
  int first_row_, last_row_ = -1;
};

}  // namespace contrejour::inline internal
