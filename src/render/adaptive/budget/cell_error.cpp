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
constexpr double kIrradianceBound = 4.0;  // the irradiance is linear in pixels rather than in the cell's coordinates
constexpr double kEdgeBound = 2.0;   // displaced edges are visible in full, levels stay below their bounds
// The fraction of the displacement of shared sides that shows where edges clip their cells.
constexpr double kShownOfShared = 0.3;
constexpr double kMaxDisplacement = 0.01;  // largest displacement of a clipping edge, over the cell's size, as drawn
constexpr double kLeftByCurvedSides =
    0.25;  // fraction of a curve's distance from its chord, left by a corner in its middle
// Fringes that are displaced by less than kSmallDisplacement_px show the fraction kVisibleOfLittle of their error,
// because they are as wide as that or fade. Found by measuring; treating all displacements alike would cost a bright
// spot 1 dB.
constexpr double kSmallDisplacement_px = 0.5, kVisibleOfLittle = 0.1;

// The displacement of a cell's sides from the mapped curves.
struct SideDisplacement {
  double strips = 0.0;  // visible squared displacements times lengths, summed
  double shared_px = 0.0, alone_px = 0.0;  // the largest displacement of shared sides and of other sides
};

// Cells that share a side have the same corners on it: they leave no gap, and an edge that clips both is displaced only
// where it crosses the side. Next to a cell of another box, or to one that is drawn as triangles, sides overlap or
// leave gaps. left: fraction of a curve's distance from its chord that remains as drawn.
SideDisplacement side_displacement(const BandContext& band, const Mesh& mesh, const Cell& cell, double left) {
  const bool cut = cell.state == CellState::Clipped;
  const bool triangles = is_dirty(band, mesh, cell) || (cut && band.iris.is_picture() && !band.pattern);
  SideDisplacement out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = mesh.position(cell.corner[k]);
    const Vec2 c = mesh.position(cell.corner[(k + 1) % 4]);
    const double displacement_px = left * length(mesh.position(cell.side[k]) - (a + c) * 0.5);
    const bool shared = cell.shared[k] && !triangles;
    double& max_px = shared ? out.shared_px : out.alone_px;
    max_px = std::max(max_px, displacement_px);
    const double shown = !shared ? 1.0 : cut ? kShownOfShared : 0.0;
    out.strips += shown * std::min(displacement_px * displacement_px, displacement_px) * length(c - a);
  }
  return out;
}

}  // namespace

// The error of a linear irradiance, whose mean is drawn as the flux over the polygon's area.
double CellError::irradiance_error(Sides sides, double width) const {
  const CellMeasure& m = measure_;
  if (m.uses_common_plane) return 0.0;
  const auto curved = [&](std::size_t k) {
    return mesh_.position(k % 2 == 0 ? cell_.corner[k / 2] : cell_.side[k / 2]);
  };
  const auto straight = [&](std::size_t k) { return mesh_.position(cell_.corner[k]); };
  const double drawn_px =
      std::abs(sides == Sides::Curved ? area_of(8, curved).signed_px : area_of(4, straight).signed_px);
  const double level_displacement = m.flux / std::max(drawn_px, 1e-12) - m.flux / std::max(m.image_px, 1e-12);
  return kIrradianceBound * (m.plane_residual + level_displacement * level_displacement) * m.area_px * width;
}

// edges: their length in lengths of the cell.
double CellError::along_edges(double visible, double displacement_px, double edges) const {
  return visible * std::min(displacement_px * displacement_px, displacement_px) * edges * measure_.longest_px;
}

// The error of looking up the stop pattern at displaced points.
double CellError::pattern_error(double visible) {
  const double longest_px = measure_.longest_px;
  if (!map_error_) map_error_ = map_error(band_, mesh_, cell_, longest_px);
  const double displacement_px = *map_error_ * longest_px;
  const double shown = displacement_px < kSmallDisplacement_px ? kVisibleOfLittle : 1.0;
  const double edges = std::min(1.0, stop_size(band_, mesh_, cell_) / (band_.pattern->fringe_unit * longest_px));
  return shown * along_edges(visible, displacement_px, edges);
}

double CellError::squared(Sides sides, double cell_budget) {
  const CellMeasure& m = measure_;
  const double transmitted = cell_.pattern.max_transmittance;
  if (transmitted == 0.0) return 0.0;
  if (m.total) return transmitted * transmitted * *m.total;
  const bool cut = cell_.state == CellState::Clipped;
  const double left = sides == Sides::Curved ? kLeftByCurvedSides : 1.0;
  if (cut && left * m.limit * transmitted > kMaxDisplacement) return std::numeric_limits<double>::infinity();

  // A sliver's flux is spread over a pixel.
  const double width = std::min(1.0, m.area_px / std::max(m.longest_px, 1e-6));
  const double visible = m.mean * m.mean * width * width;
  double error = irradiance_error(sides, width);
  const SideDisplacement off = side_displacement(band_, mesh_, cell_, left);
  error += kEdgeBound * visible * off.strips;
  // If cells meet at displaced sides, a strip takes the neighbouring cell's irradiance.
  const double displaced =
      m.uses_common_plane ? 0.0 : m.range * std::min(off.shared_px / std::max(m.longest_px, 1e-6), 1.0);
  error += kIrradianceBound * displaced * displaced * m.area_px * width;
  if (is_dirty(band_, mesh_, cell_)) error += visible * shadow_error(band_, mesh_, cell_);
  if (cut)
    error +=
        kEdgeBound * along_edges(visible, left * m.limit * m.longest_px, band_.iris.is_picture() ? kPictureEdges : 1.0);
  // Cells drawn in parts use no map.
  if (cell_.pattern.part == PatternRegion::Varying && error < m.max_error &&
      !sees_by_parts(band_, mesh_, cell_, m.longest_px))
    error += pattern_error(visible);
  // Far above the frame's peak only the relative error counts.
  const double dimmed = transmitted * peak_limited_weight(m.mean, band_.peak);
  error = std::min(error, m.max_error) * dimmed * dimmed;
  if (m.longest_px < kShownLength_px || m.mean * transmitted * width < kFacetLevel * band_.peak) return error;
  const auto shown = [&](double displacement_px) { return cell_budget * displacement_px * displacement_px; };
  if (cut) error = std::max(error, shown(off.shared_px / kCorner_px));
  return band_.has_curved_sides ? std::max(error, shown(off.alone_px / kSeam_px)) : error;
}

}  // namespace contrejour::inline internal::adaptive
