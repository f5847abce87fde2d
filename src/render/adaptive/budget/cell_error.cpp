// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/cell_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/plane_errors.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/dirt_crossings.h"
#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kPictureEdges = 6.0;  // edges that clip a cell, in lengths of it, where a picture is the iris
// The following constants were found by measuring what doubling each does to errors and to the number of cells.
constexpr double kShadeBound = 4.0;  // the irradiance is linear in pixels rather than in the cell's coordinates
constexpr double kEdgeBound = 2.0;   // displaced edges are visible in full, levels stay below their bounds
// The fraction of the displacement of shared sides that shows where edges clip their cells.
constexpr double kShownOfShared = 0.3;
constexpr double kMostOff = 0.01;     // largest displacement of a clipping edge, over the cell's size, as drawn
constexpr double kLeftByBend = 0.25;  // fraction of a curve's distance from its chord, left by a corner in its middle
// Fringes that are displaced by less than kLittleOff_px show the fraction kSeenOfLittle of their error, because they
// are as wide as that or fade. Found by measuring; treating all displacements alike would cost a bright spot 1 dB.
constexpr double kLittleOff_px = 0.5, kSeenOfLittle = 0.1;

// The displacement of a cell's sides from the mapped curves.
struct SidesOff {
  double strips = 0.0;  // visible squared displacements times lengths, summed
  double shared_px = 0.0, alone_px = 0.0;  // the largest displacement of shared sides and of other sides
};

// Cells that share a side have the same corners on it: they leave no gap, and an edge that clips both is displaced only
// where it crosses the side. Next to a cell of another box, or to one that is drawn as triangles, sides overlap or
// leave gaps. left: fraction of a curve's distance from its chord that remains as drawn.
SidesOff sides_off(const BandContext& band, const Mesh& mesh, const Cell& cell, double left) {
  const bool cut = cell.state == CellState::Cut;
  const bool triangles = is_dirty(band, mesh, cell) || (cut && band.iris.is_picture() && !band.pattern);
  SidesOff out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = mesh.position(cell.corner[k]);
    const Vec2 c = mesh.position(cell.corner[(k + 1) % 4]);
    const double off_px = left * length(mesh.position(cell.side[k]) - (a + c) * 0.5);
    const bool shared = cell.shared[k] && !triangles;
    double& most_px = shared ? out.shared_px : out.alone_px;
    most_px = std::max(most_px, off_px);
    const double shown = !shared ? 1.0 : cut ? kShownOfShared : 0.0;
    out.strips += shown * std::min(off_px * off_px, off_px) * length(c - a);
  }
  return out;
}

}  // namespace

// The error of a linear irradiance, whose mean is drawn as the flux over the polygon's area.
double CellError::shade_error(Sides sides, double width) const {
  const CellMeasure& m = measure_;
  if (m.on_plane) return 0.0;
  const auto bent = [&](std::size_t k) { return mesh_.position(k % 2 == 0 ? cell_.corner[k / 2] : cell_.side[k / 2]); };
  const auto straight = [&](std::size_t k) { return mesh_.position(cell_.corner[k]); };
  const double drawn_px = std::abs(sides == Sides::Bent ? area_of(8, bent).signed_px : area_of(4, straight).signed_px);
  const double off_level = m.flux / std::max(drawn_px, 1e-12) - m.flux / std::max(m.image_px, 1e-12);
  return kShadeBound * (m.off_plane + off_level * off_level) * m.area_px * width;
}

// edges: their length in lengths of the cell.
double CellError::along_edges(double seen, double off_px, double edges) const {
  return seen * std::min(off_px * off_px, off_px) * edges * measure_.longest_px;
}

// The error of looking up the stop pattern at displaced points.
double CellError::pattern_error(double seen) {
  const double longest_px = measure_.longest_px;
  if (!map_error_) map_error_ = map_error(band_, mesh_, cell_, longest_px);
  const double off_px = *map_error_ * longest_px;
  const double shown = off_px < kLittleOff_px ? kSeenOfLittle : 1.0;
  const double edges = std::min(1.0, stop_size(band_, mesh_, cell_) / (band_.pattern->unit * longest_px));
  return shown * along_edges(seen, off_px, edges);
}

double CellError::squared(Sides sides, double cell_budget) {
  const CellMeasure& m = measure_;
  const double passed = cell_.pattern.most;
  if (passed == 0.0) return 0.0;
  if (m.whole) return passed * passed * *m.whole;
  const bool cut = cell_.state == CellState::Cut;
  const double left = sides == Sides::Bent ? kLeftByBend : 1.0;
  if (cut && left * m.limit * passed > kMostOff) return std::numeric_limits<double>::infinity();

  // A sliver's flux is spread over a pixel.
  const double width = std::min(1.0, m.area_px / std::max(m.longest_px, 1e-6));
  const double seen = m.mean * m.mean * width * width;
  double error = shade_error(sides, width);
  const SidesOff off = sides_off(band_, mesh_, cell_, left);
  error += kEdgeBound * seen * off.strips;
  // Where cells meet at displaced sides, a strip takes the neighbouring cell's irradiance.
  const double beside = m.on_plane ? 0.0 : m.range * std::min(off.shared_px / std::max(m.longest_px, 1e-6), 1.0);
  error += kShadeBound * beside * beside * m.area_px * width;
  if (is_dirty(band_, mesh_, cell_)) error += seen * shadow_error(band_, mesh_, cell_);
  if (cut)
    error +=
        kEdgeBound * along_edges(seen, left * m.limit * m.longest_px, band_.iris.is_picture() ? kPictureEdges : 1.0);
  // Cells drawn in parts use no map.
  if (cell_.pattern.part == PatternRegion::Varying && error < m.most &&
      !sees_by_parts(band_, mesh_, cell_, m.longest_px))
    error += pattern_error(seen);
  // Far above the frame's peak only the relative error counts.
  const double dimmed = passed * seen_share(m.mean, band_.peak);
  error = std::min(error, m.most) * dimmed * dimmed;
  if (m.longest_px < kShownLength_px || m.mean * passed * width < kFacetLevel * band_.peak) return error;
  const auto shown = [&](double off_px) { return cell_budget * off_px * off_px; };
  if (cut) error = std::max(error, shown(off.shared_px / kCorner_px));
  return band_.sides_bend ? std::max(error, shown(off.alone_px / kSeam_px)) : error;
}

}  // namespace contrejour::inline internal::adaptive
