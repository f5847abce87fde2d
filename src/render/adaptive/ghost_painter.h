// One ghost of one light through one box of the pupil, from exact rays to polygons: bands of wavelengths as the first
// rays tell, patches of polynomials, cells as the error allows, band by band.
#pragma once

#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/patch_fitter.h"
#include "render/screens/stop_patterns.h"

namespace contrejour::adaptive {

// What stands in the stop for a ghost of a light, in place of the sharp iris: one a pass, the last crossing's.
struct GhostScreens {
  struct OfPass {
    std::shared_ptr<const StopScreen> screen;
    screens::PatternHull hull;  // of a pattern, as far as its light is worth drawing
  };
  std::vector<OfPass> by_pass;
  double reach = 1.0;  // the largest, likewise
  screens::EdgeProfile::Range range{0.0, 0.0};  // of edges' fringes, likewise
  double unseen = 0.0;  // pixel values that do not count
  std::shared_ptr<screens::StopPatterns> patterns;
};

class GhostPainter {
 public:
  // deepest: how often a box may be quartered before straight lines between rays must do.
  // room: for cells, used again afterwards. screens: may be null; with them the iris is a circle. dirt: whose shadows
  // are drawn, one a pass or one for all; none where the lens is clean.
  GhostPainter(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int deepest, BoxCells& room,
               const GhostScreens* screens = nullptr, std::span<const std::shared_ptr<const DirtScreen>> dirt = {});

  // box: in the light's meridional frame. with_mirror_image: that of the box is painted, too.
  void paint(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);

 private:
  struct BandPart;
  [[nodiscard]] std::vector<BandPart> parts_of(const FirstRays& rays, const Band& band) const;
  [[nodiscard]] std::optional<BentBox> bent_about(const FirstRays& rays, const Rectangle& box);
  void paint(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);
  [[nodiscard]] std::shared_ptr<const screens::BandScreen> band_screen(const FirstRays& rays, const Band& band) const;
  [[nodiscard]] std::shared_ptr<const screens::BandDirt> band_dirt(const FirstRays& rays, const Band& band) const;
  static void paint_band(const BandSet& set, std::size_t band, std::span<const FittedPart> parts, CellPainter& cells);

  GhostTracers& tracers_;
  WavelengthSamples samples_;
  const IrisShape& iris_;
  const Frame& frame_;
  int deepest_;
  const GhostScreens* screens_;
  std::span<const std::shared_ptr<const DirtScreen>> dirt_;
  BoxCells& room_;
};

}  // namespace contrejour::adaptive
