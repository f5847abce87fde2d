// One ghost of one light through one box of the pupil, from exact rays to polygons: rays at few points, polynomials
// through them, tested; more rays or smaller boxes where the test fails; cells as the error allows.
#pragma once

#include "render/adaptive/cell_painter.h"

namespace contrejour::adaptive {

// What may go wrong in all that a painter is asked to paint at once.
struct ErrorBudget {
  double squared_error = 0;  // pixel values squared, summed over the frame; infinite: no limit
  double peak = 1;           // of the frame's pixel values
};

// What stands in the stop for a ghost of a light, in place of the sharp iris: one a pass, the last crossing's.
struct GhostScreens {
  double reach = 1.0;  // the largest, as far as their light is worth drawing
  screens::EdgeProfile::Range range{0.0, 0.0};  // likewise, of edges' fringes
  std::vector<std::shared_ptr<const StopScreen>> by_pass;
  std::shared_ptr<RingingPatterns> patterns;
};

class GhostPainter {
 public:
  // deepest: how often a box may be quartered before straight lines between rays must do.
  // screens: may be null; with them the iris is a circle. dirt: whose shadows are drawn; may be null.
  GhostPainter(const LensState& lens, const IrisShape& iris, const Frame& frame, const LightFrame& light,
               const TablesByWavelength& tables, int deepest, const GhostScreens* screens = nullptr,
               const screens::DirtField* dirt = nullptr);

  // box: in the light's meridional frame. Passes by rising wavelength.
  void paint(Ghost ghost, const Rectangle& box, std::span<const PlannedPass> passes, const ErrorBudget& budget,
             PolygonList& out);

  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] std::uint64_t surface_hits() const { return surface_hits_; }

 private:
  struct Tolerance {
    double position_px = 0, stop = 0, weight = 0;
  };
  [[nodiscard]] Tolerance tolerance_for(const std::vector<RaySheet>& sheets, const ErrorBudget& budget) const;
  [[nodiscard]] static bool accepts(const Patch& patch, const Tolerance& tolerance);
  [[nodiscard]] PacketPrecision precision_for(const Rectangle& box, const Tolerance& tolerance) const;
  [[nodiscard]] std::vector<RaySheet> first_sheets(Ghost ghost, const Rectangle& box,
                                                   std::span<const PlannedPass> passes);
  [[nodiscard]] double stop_times() const { return screens_ != nullptr ? screens_->reach : 1.0; }
  [[nodiscard]] std::shared_ptr<const BandScreen> band_screen(const std::vector<RaySheet>& sheets, std::size_t first,
                                                              std::size_t last) const;
  [[nodiscard]] double shift_px(const RaySheet& a, const RaySheet& b) const;

  void paint_box(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance, CellPainter& cells);
  void paint_quarters(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance,
                      CellPainter& cells);
  void count(const SheetTracer& tracer);

  const LensState& lens_;
  const IrisShape& iris_;
  const Frame& frame_;
  const LightFrame& light_;
  const TablesByWavelength& tables_;
  double plane_z_mm_;
  int deepest_;
  const GhostScreens* screens_;
  const screens::DirtField* dirt_;
  std::uint64_t rays_ = 0, surface_hits_ = 0;
};

}  // namespace contrejour::adaptive
