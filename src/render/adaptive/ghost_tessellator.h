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
struct GhostPatterns {
  struct OfPass {
    std::shared_ptr<const StopPattern> pattern;
    stop_patterns::BoundingPolygon bounding_polygon;  // bounding polygon of a pattern's visible light
  };
  std::vector<OfPass> by_pass;
  double outer_radius = 1.0;  // largest radius of visible light
  stop_patterns::EdgeProfile::Range range{0.0, 0.0};  // visible range of edges' fringes
  double negligible_level = 0.0;  // pixel values that are negligible
  std::shared_ptr<stop_patterns::StopPatterns> patterns;
};

class GhostTessellator {
 public:
  // max_depth: how often a box may be quartered before straight lines between rays must do. scratch: scratch memory for
  // cells. patterns: may be null; if given, the iris is a circle. dirt: the shadows to draw, one a pass or one for all;
  // empty for a clean lens.
  GhostTessellator(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int max_depth, BoxCells& scratch,
                   const GhostPatterns* patterns = nullptr,
                   std::span<const std::shared_ptr<const DirtShadows>> dirt = {});

  // Once the context is cancelled, polygons may be missing. It outlives this object; null: never.
  void stop_with(const Context* context) { context_ = context; }

  // box: in the light's meridional frame. with_mirror_image: whether the box's mirror image is painted, too.
  void tessellate(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);

 private:
  struct BandPart;
  [[nodiscard]] std::vector<BandPart> parts_of(const FirstRays& rays, const Band& band) const;
  [[nodiscard]] std::optional<CurvedBox> curved_about(const FirstRays& rays, const Rectangle& box);
  void tessellate(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);
  [[nodiscard]] std::shared_ptr<const stop_patterns::BandStopPattern> band_pattern(const FirstRays& rays,
                                                                                   const Band& band) const;
  [[nodiscard]] std::shared_ptr<const stop_patterns::BandDirt> band_dirt(const FirstRays& rays, const Band& band) const;
  void tessellate_band(const BandSet& set, std::size_t band, std::span<const FittedPart> parts,
                       Tessellator& cells) const;

  GhostTracers& tracers_;
  WavelengthSamples samples_;
  const IrisShape& iris_;
  const Frame& frame_;
  int max_depth_;
  const GhostPatterns* patterns_;
  std::span<const std::shared_ptr<const DirtShadows>> dirt_;
  BoxCells& scratch_;
  const Context* context_ = nullptr;
};

}  // namespace contrejour::inline internal::adaptive
