// SPDX-License-Identifier: Apache-2.0
// A ghost's light, cell by cell of the entrance plane: the whole window is divided into cells, and each cell is
// subdivided until its image on the sensor is small and has nearly straight edges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "contrejour/expert/trace.h"
#include "contrejour/frame.h"
#include "render/stop_patterns/stop_transmittance.h"

namespace contrejour::inline internal::reference {

struct CellLimits {
  int root_cells = 192;            // on a side of the window, before any subdivision
  double footprint_px = 4.0;       // longest side of a cell's image
  double pattern_footprint_px = 1.0;  // the longest side where a stop pattern is neither dark nor uniform
  double dirt_footprint_px = 0.35;   // the longest side where dirt lies: light is spread evenly over each triangle
  double cut_footprint_px = 1.0;   // the longest side where a rim or the iris's edge cuts the cell
  double sag_px = 0.1;            // distance of the middle's image from the mean of the corners'
  double edge_sag = 0.005;        // bow of an edge within the cell that it cuts, over the cell's size
  int search_depth = 3;              // depth to which dark cells with a failed ray are searched
  int blind_depth = 1;             // depth to which cells with failed rays only are searched
  int max_depth = 12;                // subdivisions of a root cell

  // Density 2 halves every length.
  [[nodiscard]] static CellLimits for_density(double density);
};

// A convex polygon of the sensor, in pixels, and the flux (mm^2 at E0 = 1) that falls on it.
using LitPolygon = std::function<void(std::span<const Vec2> pixels, double flux_mm2)>;

struct CellCounts {
  std::uint64_t rays = 0;
  std::uint64_t polygons = 0;
};

// Calls `lit` for every open piece of every cell that may fall inside the frame. Stops early, with the pieces passed on
// so far, once `stop()` is true. path and iris: as the stop's transmittance requires, which is looked up for every
// triangle.
CellCounts for_each_lit_polygon(const OpticalPath& path, const Iris& iris, const LightSource& light,
                                const EntranceWindow& window, const Frame& frame, const CellLimits& limits,
                                const std::function<bool()>& stop, const LitPolygon& lit,
                                const StopTransmittance& transmittance = {});

}  // namespace contrejour::inline internal::reference
