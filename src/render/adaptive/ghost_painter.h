// SPDX-License-Identifier: Apache-2.0
// Draws one ghost of one light through one box of the pupil, from exact rays to polygons: chooses bands of wavelengths
// from the first rays, fits polynomials in patches, and tessellates them into cells that the error allows, band by
// band.
#pragma once

#include "render/adaptive/patch_fitter.h"
#include "render/adaptive/tessellator.h"
#include "render/stop_patterns/stop_patterns.h"

namespace contrejour::inline internal::adaptive {

// The stop patterns of a ghost of a light at its last crossing of the stop, in place of the sharp iris: one a pass.
struct GhostScreens {
  struct OfPass {
    std::shared_ptr<const StopScreen> screen;
    screens::PatternHull hull;  // bounding polygon of a pattern's visible light
  };
  std::vector<OfPass> by_pass;
  double reach = 1.0;  // largest radius of visible light
  screens::EdgeProfile::Range range{0.0, 0.0};  // visible range of edges' fringes
  double unseen = 0.0;  // pixel values that are negligible
  std::shared_ptr<screens::StopPatterns> patterns;
};

class GhostPainter {
 public:
  // deepest: how often a box may be quartered before straight lines between rays must do. room: scratch memory for
  // cells. screens: may be null; if given, the iris is a circle. dirt: the shadows to draw, one a pass or one for all;
  // empty for a clean lens.
  GhostPainter(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int deepest, BoxCells& room,
               const GhostScreens* screens = nullptr, std::span<const std::shared_ptr<const DirtScreen>> dirt = {});

  // box: in the light's meridional frame. with_mirror_image: whether the box's mirror image is painted, too.
  void paint(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);

 private:
  struct BandPart;
  [[nodiscard]] std::vector<BandPart> parts_of(const FirstRays& rays, const Band& band) const;
  [[nodiscard]] std::optional<BentBox> bent_about(const FirstRays& rays, const Rectangle& box);
  void paint(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);
  [[nodiscard]] std::shared_ptr<const screens::BandScreen> band_screen(const FirstRays& rays, const Band& band) const;
  [[nodiscard]] std::shared_ptr<const screens::BandDirt> band_dirt(const FirstRays& rays, const Band& band) const;
  static void paint_band(const BandSet& set, std::size_t band, std::span<const FittedPart> parts, Tessellator& cells);

  GhostTracers& tracers_;
  WavelengthSamples samples_;
  const IrisShape& iris_;
  const Frame& frame_;
  int deepest_;
  const GhostScreens* screens_;
  std::span<const std::shared_ptr<const DirtScreen>> dirt_;
  BoxCells& room_;
};

}  // namespace contrejour::inline internal::adaptive
