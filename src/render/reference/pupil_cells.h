// A ghost's light, cell by cell of the entrance plane: the whole window is cut into cells and each cell into
// smaller ones until its image on the sensor is small and all but straight-edged.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>

#include "contrejour/frame.h"
#include "contrejour/trace.h"
#include "render/interface/dirt_screen.h"
#include "render/interface/stop_screen.h"

namespace contrejour::reference {

struct CellLimits {
  int root_cells = 192;            // a side of the window, before any subdivision
  double footprint_px = 4.0;       // longest side of a cell's image
  double screen_footprint_px = 1.0;  // the same where a screen is neither dark nor level
  double dirt_footprint_px = 0.35;   // where dirt lies: a triangle's light is spread evenly over it, shadows and all
  double cut_footprint_px = 1.0;   // the same where a rim or the iris edge cuts the cell
  double bend_px = 0.1;            // a cell's middle off the mean of its corners
  double edge_bend = 0.005;        // how far an edge may bow within the cell it cuts, over the cell's size
  int look_depth = 3;              // dark cells with a ray that fails are searched to this depth
  int blind_depth = 1;             // likewise where all rays fail
  int deepest = 12;                // subdivisions of a root cell

  // Density 2 halves every length.
  [[nodiscard]] static CellLimits for_density(double density);
};

// A convex polygon of the sensor, in pixels, and the flux (mm^2 at E0 = 1) that falls on it.
using LitPolygon = std::function<void(std::span<const Vec2> pixels, double flux_mm2)>;

struct CellCounts {
  std::uint64_t rays = 0;
  std::uint64_t polygons = 0;
};

// Calls `lit` for every open piece of every cell that may fall inside the frame. Stops early, with whatever has
// been passed on so far, once `stop()` is true. screen: looked up for every triangle; the path is then a widened one,
// the iris a circle (stop_screen.h). dirt: looked up for every triangle, too. Both may be null.
CellCounts for_each_lit_polygon(const OpticalPath& path, const Iris& iris, const LightSource& light,
                                const EntranceWindow& window, const Frame& frame, const CellLimits& limits,
                                const std::function<bool()>& stop, const LitPolygon& lit,
                                const StopScreen* screen = nullptr, const DirtScreen* dirt = nullptr);

}  // namespace contrejour::reference
