// SPDX-License-Identifier: Apache-2.0
// From a traced grid to primitives: bodonyi2023 4.1 and 4.2.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/frame.h"
#include "contrejour/method_options.h"
#include "ghosts/ray_grid.h"
#include "render/planning/dirt_field.h"
#include "render/tiled/primitive.h"

namespace contrejour::inline internal::tiled {

// The ghost, light and wavelength of a traced grid, as far as primitives need them.
struct TracedPass {
  double shared_flux = 1;  // LightSource's
  std::uint32_t pass = 0;
  Vec2 shift_mm = {};      // of the ghost, on the sensor
  const DirtSite* front_dirt = nullptr;  // not null: points on the front are kept, since there is dirt
  LightSource light = {};
  double entrance_z_mm = 0.0;  // of the grid
};

// Makes a primitive of each cell of four rays of which at least one gets through. 2 x 2 primitives that bend by less
// than gamma are merged into one, and four merged ones again, up to `merge_steps` times. A primitive's flux is the sum
// of its cells' fluxes. Cells that are not convex, or have a failed ray, are not merged and are split into triangles.
// Buffers are kept between grids; one object for each thread.
class PrimitiveBuilder {
 public:
  PrimitiveBuilder(const Frame& frame, const TiledOptions& options);

  // Appends to `out`. Returns the number of primitives before merging.
  std::uint64_t build(const RayGrid& grid, const TracedPass& traced, PrimitiveBuffer& out);

 private:
  enum class CellState : std::uint8_t { Dark, Whole, InTriangles };

  // Blocks of 2^step cells a side.
  struct Level {
    int side = 0;
    std::vector<std::uint8_t> is_whole;
    std::vector<float> flux;
    [[nodiscard]] std::size_t at(int ix, int iy) const {
      return static_cast<std::size_t>(iy) * static_cast<std::size_t>(side) + static_cast<std::size_t>(ix);
    }
  };

  void place_vertices(const RayGrid& grid, Vec2 shift_mm);
  void find_cells(const RayGrid& grid);
  void find_irradiance(const RayGrid& grid);
  void merge(const RayGrid& grid);
  [[nodiscard]] bool is_flat(const RayGrid& grid, int step, int ix, int iy) const;
  [[nodiscard]] bool is_open(const RayGrid& grid, int step, int ix, int iy) const;
  void widen(const RayGrid& grid);  // a ghost too narrow for sampling at pixels' middles
  [[nodiscard]] double twice_area(std::size_t i, std::size_t j, std::size_t k) const;
  [[nodiscard]] bool is_convex(const std::array<std::size_t, 4>& corners) const;

  // Appends all primitives within the block of 2^step cells a side.
  void emit(const RayGrid& grid, int step, int ix, int iy);
  void emit_quad(const RayGrid& grid, std::array<std::size_t, 4> corners, double flux);
  void emit_triangle(const RayGrid& grid, std::array<std::size_t, 3> corners);
  void fill(const RayGrid& grid, std::array<std::size_t, 4> corners, Primitive& primitive);

  const Frame& frame_;
  int merge_steps_;
  float merge_threshold_px_;
  double triangle_weight_mm2_ = 0;   // flux of half a cell of transmittance 1
  std::vector<float> x_, y_;         // by vertex, pixels
  std::vector<float> area_;          // by cell with a border of one cell, signed, pixels; NaN where a ray failed
  std::vector<float> irradiance_;    // by vertex, flux over area; 0 where the map is not smooth
  std::vector<CellState> state_;     // by cell
  std::vector<Level> levels_;        // levels_[k]: after k steps
  TracedPass traced_;
  PrimitiveBuffer* out_ = nullptr;
};

}  // namespace contrejour::inline internal::tiled
