// SPDX-License-Identifier: Apache-2.0
// Converts a design's surfaces to rows of a prescription.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "optics/lens_files/sequential/sequential_design.h"

namespace contrejour::inline internal {

// A row, and the surfaces of the design whose thicknesses add up to the gap behind it.
struct DesignRow {
  Surface surface;
  std::vector<std::size_t> gap;
  Placement own;
  std::size_t of = 0;  // the design's surface
};

// Makes rows of the surfaces that refract, block or stop light; a stop on a surface becomes a row in front of it.
// Errors: no lens, no stop or more than one.
[[nodiscard]] Result<std::vector<DesignRow>> rows_of(const SequentialDesign& design,
                                                     std::vector<std::string>& warnings);

// The gap behind a row for these thicknesses of the design's surfaces.
[[nodiscard]] double gap_mm(const DesignRow& row, const std::vector<double>& thickness, double unit_mm);

// The gaps behind all rows. A stop or an opening behind the vertex of the next surface, which a negative gap indicates,
// is moved to that vertex.
[[nodiscard]] std::vector<double> gaps_mm(const std::vector<DesignRow>& rows, const std::vector<double>& thickness,
                                          double unit_mm);

}  // namespace contrejour::inline internal
