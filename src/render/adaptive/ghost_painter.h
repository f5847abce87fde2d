// One ghost of one light through one box of the pupil, from exact rays to polygons: rays at few points, polynomials
// through them, tested; more rays or smaller boxes where the test fails; cells as the error allows.
#pragma once

#include "render/adaptive/band_set.h"
#include "render/adaptive/cell_painter.h"

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
  std::shared_ptr<RingingPatterns> patterns;
};

// For the cells of one ghost after the other: their memory is not asked for again.
struct GhostRoom {
  CellRoom cells, of_mirror_image;
};

class GhostPainter {
 public:
  // deepest: how often a box may be quartered before straight lines between rays must do.
  // screens: may be null; with them the iris is a circle. dirt: whose shadows are drawn; may be null.
  GhostPainter(GhostTracers& tracers, const IrisShape& iris, const Frame& frame, int deepest, GhostRoom& room,
               const GhostScreens* screens = nullptr, const screens::DirtField* dirt = nullptr);

  // box: in the light's meridional frame. with_mirror_image: that of the box is painted, too.
  void paint(const Rectangle& box, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);

 private:
  using BandScreens = std::vector<std::shared_ptr<const BandScreen>>;  // one a band; null: the iris is sharp
  // What boxes are painted with.
  struct Painting {
    Tolerance tolerance;
    BandScreens screens;  // those of the bands of the set
    CellPainter& cells;
    CellPainter* mirror_image = nullptr;  // of the boxes, if it is painted with them
    std::size_t first_band = 0;           // of those of the set, of all
  };
  // A box, or a quarter of a quarter of one.
  struct BoxPart {
    Rectangle box;
    MeshPlace place;
    int depth = 0;
  };

  [[nodiscard]] std::optional<BentBox> bent_about(const FirstRays& rays, const Rectangle& box);
  void paint(const FirstRays& rays, bool with_mirror_image, const ErrorBudget& budget, PolygonList& out);
  [[nodiscard]] PacketPrecision precision_for(const Rectangle& box, const Tolerance& tolerance) const;
  [[nodiscard]] std::shared_ptr<const BandScreen> band_screen(const FirstRays& rays, const Band& band) const;

  void paint_bands(BandSet& bands, std::span<const RaySheet> first, const Painting& painting);
  [[nodiscard]] BoxPart whole(const Rectangle& box, int depth = 0);
  [[nodiscard]] bool is_symmetric(const Rectangle& box) const;
  void paint_part(BandSet& bands, const BoxPart& part, std::optional<double> first_misfit, const Painting& painting);
  [[nodiscard]] double misfit(const BandSet& bands, std::span<const Patch> patches, const Tolerance& tolerance) const;
  void paint_patches(const BandSet& bands, std::span<const RaySheet> sheets, std::span<const Patch> patches,
                     const MeshPlace& place, const Painting& painting) const;
  void paint_between_rays(BandSet& bands, const BoxPart& part, std::span<const RaySheet> sheets,
                          const Painting& painting);
  [[nodiscard]] std::optional<double> level_behind(const BandSet& bands, std::span<const RaySheet> sheets,
                                                   const Painting& painting) const;
  void paint_quarters(BandSet& bands, const BoxPart& part, const Painting& painting);
  void stand_behind(const std::shared_ptr<const BandScreen>& screen, CellPainter& cells) const;

  GhostTracers& tracers_;
  WavelengthSamples samples_;
  const IrisShape& iris_;
  const Frame& frame_;
  int deepest_;
  const GhostScreens* screens_;
  const screens::DirtField* dirt_;
  GhostRoom& room_;
  int boxes_ = 0;  // so far
};

}  // namespace contrejour::adaptive
