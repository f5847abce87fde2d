// SPDX-License-Identifier: Apache-2.0
// Rasterises a traced grid: it spreads every cell's flux over the cell's image, hullin2011 4.1 "rasterization and
// shading". Within a cell the irradiance follows that of the vertices (cell areas averaged to vertices), but the flux
// of every triangle is its own: where cells fold or differ strongly from their neighbours the irradiance is constant.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "contrejour/frame.h"
#include "render/bundle/cell_clip.h"
#include "render/bundle/flux_box.h"
#include "render/stop_patterns/shadow_clipper.h"
#include "render/stop_patterns/stop_transmittance.h"

namespace contrejour::inline internal::bundle {

struct CellStyle {
  bool smooth_shading = true;  // off: the irradiance is constant within a cell
  bool points = false;         // every cell's flux goes to the pixel of its middle: hullin2011 7.2
};

// What the stop transmits of the grid's ghost. light, entrance_z_mm: those of the grid. rotation_rad rotates the grid's
// crossings of the stop and the front into the lens's orientation.
struct GridStop {
  StopTransmittance transmittance;
  LightSource light;
  double entrance_z_mm = 0.0;
  double rotation_rad = 0.0;
};

class CellRaster {
 public:
  // iris: rotated to the grid's crossings of the stop. shared_flux: LightSource's.
  CellRaster(const RayGrid& grid, const IrisShape& iris, const Frame& frame, double shared_flux, CellStyle style = {},
             GridStop stop = {});

  // Flux in mm^2 at E0 = 1 by pixel, over the part of the frame that the ghost touches. Stops early, with the part that
  // is done, once `stop()` is true.
  [[nodiscard]] FluxBox draw(const std::function<bool()>& stop);

  [[nodiscard]] std::uint64_t primitives() const { return primitives_; }

 private:
  enum class CellState : std::uint8_t { Closed, Cut, Open };

  struct Cell {
    std::array<std::size_t, 4> vertex;
    double signed_area_px = 0;
    Vec2 gradient;  // of the irradiance, relative to its mean, per pixel; zero unless smooth
    bool smooth = false;
  };

  void place_vertices();
  void find_states();
  void find_irradiance();
  [[nodiscard]] CellState state_of(const std::array<std::size_t, 4>& corners) const;
  [[nodiscard]] PixelBox drawn_box() const;
  [[nodiscard]] bool outside(const PixelBox& box, const std::array<std::size_t, 4>& corners) const;
  [[nodiscard]] Cell cell_at(int ix, int iy) const;
  [[nodiscard]] double triangle_flux(const Triangle& t) const;

  void draw_cell(FluxBox& out, const Cell& cell, CellState state);
  void draw_point(FluxBox& out, const Cell& cell, CellState state);
  [[nodiscard]] double open_flux(const Triangle& t, CellState state);
  [[nodiscard]] bool failed(std::span<const std::size_t> vertices) const;
  void draw_open(FluxBox& out, const Cell& cell);
  void draw_triangle(FluxBox& out, const Cell& cell, const Triangle& t, bool cut);
  [[nodiscard]] StopCrossings crossings_of(std::size_t vertex) const;
  [[nodiscard]] std::array<StopCrossings, 3> crossings_of(const Triangle& t) const {
    return {crossings_of(t[0]), crossings_of(t[1]), crossings_of(t[2])};
  }
  void sample_stop_pattern(const std::array<std::size_t, 4>& corners);
  [[nodiscard]] bool has_outlines() const { return dirty_ && stop_.transmittance.dirt->outlines() != nullptr; }
  [[nodiscard]] double transmittance(const std::array<StopCrossings, 3>& triangle, Vec2 uv, double pixels,
                                     bool with_dirt) const;
  void draw_shadows(FluxBox& out, std::span<const Vec2> polygon, const Triangle& t, const Density& density);
  void draw_polygon(FluxBox& out, const Cell& cell, const Triangle& t, std::span<const Vec2> polygon, double fraction,
                    double open);
  [[nodiscard]] static double finest(const std::array<Vec2, 3>& p);
  [[nodiscard]] std::size_t cell_index(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(grid_.cells()) + static_cast<std::size_t>(ix);
  }

  const RayGrid& grid_;
  const Frame& frame_;
  CellStyle style_;
  GridStop stop_;
  // Those of the present cell: what the stop pattern is there, and whether dirt takes light.
  PatternRegion region_ = PatternRegion::Uniform;
  bool dirty_ = false;
  stop_patterns::ShadowClipper shadows_;
  TriangleClipper clipper_;
  double triangle_weight_mm2_;  // flux of a triangle of transmittance 1
  std::vector<Vec2> pixel_;  // by vertex
  std::vector<float> area_;  // by cell, signed, pixels; NaN where a ray failed
  std::vector<float> irradiance_;  // by vertex, flux over pixel area; 0 where the map is not smooth
  std::vector<CellState> state_;  // by cell
  std::vector<Vec2> corner_scratch_;
  std::uint64_t primitives_ = 0;
};

}  // namespace contrejour::inline internal::bundle
