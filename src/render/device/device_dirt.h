// SPDX-License-Identifier: Apache-2.0
// The dirt of a lens with sharp shadows, as plain data for a device: shapes and a picture, as DirtField has them.
// Units: mm of the dirt's plane.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "contrejour/expert/dirt.h"

namespace contrejour::inline internal {

struct DeviceStroke {  // a DirtStroke
  Vec2 middle_mm, along;  // along: a unit vector, of the line at its middle
  double half_length_mm = 0.0, half_width_mm = 0.0;
  double radius_mm = 0.0;  // of the line, positive if its centre lies to the left; 0: straight
  double opacity = 1.0;
};

// Cells are those of a grid over the square from -extent to extent, row by row from the lowest coordinates.
struct DeviceDirt {
  bool on_front = false;  // else in the stop
  double mm_a_unit = 1.0;  // of the points where rays cross the plane: the stop's radius, or 1 on the front
  double extent_mm = 1.0;
  double edges_per_mm = 0.0;  // DirtEdges
  std::uint32_t cells = 1;    // a side
  std::vector<DeviceStroke> strokes;
  std::vector<std::uint32_t> first, of_cell;  // strokes about cell k: of_cell[first[k]] to of_cell[first[k + 1] - 1]
  // By corner of cells, (cells + 1)^2: sums over all cells with lower coordinates, of the fraction of light that
  // strokes block in each, and of the number of those with strokes.
  std::vector<float> blocked_before;
  std::vector<std::uint32_t> dirty_before;
  bool has_outlines = true;  // grids of rays draw shadows as shapes' outlines (DirtField::outlines())
  std::shared_ptr<const DirtPicture> picture;  // null: none
  double clear_radius_mm = 1.0;                // that the picture spans

  // The largest number of strokes about a cell.
  [[nodiscard]] std::uint32_t most_about_cell() const {
    std::uint32_t most = 0;
    for (std::size_t k = 1; k < first.size(); ++k) most = std::max(most, first[k] - first[k - 1]);
    return most;
  }
};

}  // namespace contrejour::inline internal
