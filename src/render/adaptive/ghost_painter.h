// One ghost of one light in one band of wavelengths, from exact rays to polygons: rays at few points, polynomials
// through them, tested, more rays or smaller boxes where the test fails, cells as the error allows.
#pragma once

#include "render/adaptive/cell_painter.h"

namespace contrejour::adaptive {

// What may go wrong, per item of work.
struct ErrorBudget {
  double squared_error = 0;  // pixel values squared, summed over the frame; infinite: no limit
  double peak = 1;           // of the frame's pixel values
};

struct PaintJob {
  Ghost ghost;
  Rectangle box;  // of the pupil, in the light's meridional frame, y symmetric
  Band band;
};

class GhostPainter {
 public:
  // deepest: how often the pupil may be quartered before straight lines between rays must do.
  GhostPainter(const LensState& lens, const IrisShape& iris, const Frame& frame, const Meridian& meridian,
               double plane_z_mm, const TablesByWavelength& tables, int deepest)
      : lens_(lens), iris_(iris), frame_(frame), meridian_(meridian), plane_z_mm_(plane_z_mm), tables_(tables),
        deepest_(deepest) {}

  void paint(const PaintJob& job, const ErrorBudget& budget, PolygonList& out);

  [[nodiscard]] std::uint64_t rays() const { return rays_; }
  [[nodiscard]] std::uint64_t surface_hits() const { return surface_hits_; }

 private:
  struct Tolerance {
    double position_px = 0, stop = 0, weight = 0;
  };
  [[nodiscard]] Tolerance tolerance_for(const RaySheet& sheet, const ErrorBudget& budget) const;
  [[nodiscard]] PacketPrecision precision_for(const Rectangle& box, const Tolerance& tolerance) const;
  [[nodiscard]] static bool accepts(const Patch& patch, const Tolerance& tolerance);
  void paint_box(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance, CellPainter& cells);
  void paint_sheet(const RaySheet& sheet, CellPainter& cells) const;
  void paint_quarters(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance, CellPainter& cells);

  const LensState& lens_;
  const IrisShape& iris_;
  const Frame& frame_;
  const Meridian& meridian_;
  double plane_z_mm_;
  const TablesByWavelength& tables_;
  int deepest_;
  std::uint64_t rays_ = 0, surface_hits_ = 0;
};

}  // namespace contrejour::adaptive
