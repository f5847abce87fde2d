// SPDX-License-Identifier: Apache-2.0
// The errors of drawing a cell as one polygon: squared, summed over its pixels, compared with the cell's budget. They
// also decide how finely arcs are divided into chords.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kPixel = 1.0;       // area below which only a cell's flux is visible
constexpr double kPictureEdges = 6.0;  // edges that clip a cell, in lengths of it, where a picture is the iris
// The following constants were found by measuring what doubling each does to errors and to the number of cells.
constexpr double kShadeBound = 4.0;  // the irradiance is linear in pixels rather than in the cell's coordinates
constexpr double kEdgeBound = 2.0;  // displaced edges are visible in full, levels stay below their bounds
constexpr double kFoldBound = 0.5;  // fraction of the largest possible error that a folded cell makes
constexpr double kShownOfShared =
    0.3;  // fraction of the displacement of shared sides that shows where edges clip their cells
constexpr double kMostBend = 0.04;  // largest displacement of a clipping edge, over the cell's size
constexpr double kMostOff = 0.01;   // the same, after any corners in the middles of sides reduce it
constexpr double kLeftByBend = 0.25;  // fraction of a curve's distance from its chord, left by a corner in its middle
constexpr double kChordShare = 0.5;  // fraction of a cell's error that chords in place of an arc may make
// The largest distance of chords from their arc, whatever the budget: in ghosts brighter than kFacetLevel larger ones
// show corners.
constexpr double kMostOfChord_px = 0.5, kMostOfSeenChord_px = 0.25;
constexpr double kObscurationBend = 3.0;  // an obscuration's edge still curves where that corner is: found by measuring
// Fringes that are displaced by less than kLittleOff_px show the fraction kSeenOfLittle of their error, because they
// are as wide as that or fade. Found by measuring; treating all displacements alike would cost a bright spot 1 dB.
constexpr double kLittleOff_px = 0.5, kSeenOfLittle = 0.1;
// In a cell larger than kFacet_px and brighter than kFacetLevel of the peak, a plane that is off by more than kFacet of
// the mean shows as a facet, however small the error is relative to the peak.
constexpr double kFacet = 0.02, kFacet_px = 400.0, kFacetLevel = 2e-4;
// Limits for cells longer than kShownLength_px in ghosts brighter than kFacetLevel. A gap wider than kSeam_px shows as
// a line where a side, bent only by the shape of its box, meets a cell of another box. An edge that crosses a side more
// than kCorner_px from its true position shows a corner.
constexpr double kShownLength_px = 8.0, kSeam_px = 0.07, kCorner_px = 1.0;

// The mean square residual of the best plane through a cell's nine vertices, row by row.
template <class ValueAt>
double off_plane(const ValueAt& at) {
  std::array<double, 9> e;
  for (std::size_t k = 0; k < 9; ++k) e[k] = at(k);
  const double mean = (e[0] + e[1] + e[2] + e[3] + e[4] + e[5] + e[6] + e[7] + e[8]) / 9.0;
  const double along_u = (e[2] + e[5] + e[8] - e[0] - e[3] - e[6]) / 6.0;
  const double along_v = (e[6] + e[7] + e[8] - e[0] - e[1] - e[2]) / 6.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double plane =
        mean + along_u * (static_cast<double>(k % 3) - 1.0) + along_v * (static_cast<double>(k / 3) - 1.0);
    sum += (e[k] - plane) * (e[k] - plane) / 9.0;
  }
  return sum;
}

// The distance between the points at which a side crosses the value 1, for the parabola through the values at its ends
// and its middle, and for the line between its ends: as a fraction of the side; 0 where neither crosses. The local
// slope is used, since heights next to failing rays rise so steeply that the mean slope says little.
double off_crossing(double from, double middle, double to) {
  if ((from - 1.0) * (to - 1.0) >= 0.0) return 0.0;
  const double t = (1.0 - from) / (to - from);
  const double curvature = 2.0 * (from - 2.0 * middle + to);
  const double slope = to - from + curvature * (2.0 * t - 1.0);
  const double miss = std::abs(curvature * t * (1.0 - t));
  return miss < std::abs(slope) ? miss / std::abs(slope) : 1.0;
}

}  // namespace

bool CellPainter::shows_facets(double area_px, double mean, double off_plane) const {
  return area_px > kFacet_px && mean > kFacetLevel * peak_ && off_plane > kFacet * kFacet * mean * mean;
}

CellPainter::CellMeasure CellPainter::measure(const Mesh& mesh, const Cell& cell, State state, bool on_plane) const {
  const std::array<std::size_t, 9> v{cell.corner[0], cell.side[0],   cell.corner[1], cell.side[3],  cell.middle,
                                     cell.side[1],   cell.corner[3], cell.side[2],   cell.corner[2]};
  CellMeasure m;
  if (cell.screen.most == 0.0) return m;
  Bounds b;
  bool folded = false;
  double sum = 0.0;
  for (const std::size_t k : v) {
    b.add(mesh.position(k));
    folded = folded || mesh.area[k] * mesh.area[cell.middle] <= 0.0F;
    sum += mesh.brightness[k];
  }
  m.mean = sum / 9.0;
  const Vec2 extent = b.size();
  const double box = std::max(extent.x, kPixel) * std::max(extent.y, kPixel);
  // An upper bound for any cell: its whole flux is displaced within its bounds.
  const double flux = std::abs(mesh.brightness[cell.middle] * mesh.area[cell.middle]) * cell.size * cell.size;
  // A shape smaller than a pixel that moves by a quarter of its size changes the pixels by an eighth of the squared
  // size.
  const double seen_part = dot(extent, extent) / (dot(extent, extent) + 8.0);
  const double worst = flux * flux / box * seen_part;
  if (folded) {
    const double seen = seen_share(flux / box, peak_);
    m.whole = kFoldBound * worst * seen * seen;
    return m;
  }
  const auto e = [&](std::size_t k) { return static_cast<double>(mesh.brightness[v[k]]); };
  m.on_plane = on_plane;
  if (!on_plane) m.off_plane = off_plane(e);
  const auto [lowest, highest] = std::ranges::minmax(v, {}, [&](std::size_t k) { return mesh.brightness[k]; });
  m.range = static_cast<double>(mesh.brightness[highest]) - mesh.brightness[lowest];
  m.area_px = std::abs(mesh.area[cell.middle]) * cell.size * cell.size;
  if (!on_plane && m.area_px > kFacet_px && m.mean * cell.screen.most > kFacetLevel * peak_) {
    double facet = mesh.layout.weights == 1 ? m.off_plane : 0.0;
    for (int c = 0; c < 3 && mesh.layout.weights == 3; ++c)
      facet += off_plane([&](std::size_t k) { return mesh.irradiance(c, v[k]); }) / 3.0;
    if (facet > kFacet * kFacet * m.mean * m.mean) {
      m.whole = std::numeric_limits<double>::infinity();
      return m;
    }
  }
  if (state == State::Cut) {
    m.limit = limit_error(mesh, cell);
    if (m.limit * cell.screen.most > kMostBend) {
      m.whole = std::numeric_limits<double>::infinity();  // or light would be lost unnoticed
      return m;
    }
  }
  for (std::size_t k = 0; k < 9; ++k) {
    const double part = kSimpson[k % 3] * kSimpson[k / 3] * std::abs(mesh.area[v[k]]) * cell.size * cell.size;
    m.image_px += part;
    m.flux += part * e(k);
  }
  m.longest_px = std::max(extent.x, extent.y);
  m.most = 4.0 * worst;
  return m;
}

// The squared error of drawing the cell as one polygon with a linear irradiance, summed over its pixels.
double CellPainter::squared_error(const Mesh& mesh, const Cell& cell, CellMeasure& m, State state, Sides sides) const {
  const double passed = cell.screen.most;
  if (passed == 0.0) return 0.0;
  if (m.whole) return passed * passed * *m.whole;
  const double width =
      std::min(1.0, m.area_px / std::max(m.longest_px, 1e-6));  // a sliver's flux is spread over a pixel
  double error = 0.0;
  if (!m.on_plane) {  // the drawn mean irradiance is the flux over the polygon's area
    const auto bent = [&](std::size_t k) { return mesh.position(k % 2 == 0 ? cell.corner[k / 2] : cell.side[k / 2]); };
    const auto straight = [&](std::size_t k) { return mesh.position(cell.corner[k]); };
    const double drawn_px =
        std::abs(sides == Sides::Bent ? area_of(8, bent).signed_px : area_of(4, straight).signed_px);
    const double off_level = m.flux / std::max(drawn_px, 1e-12) - m.flux / std::max(m.image_px, 1e-12);
    error = kShadeBound * (m.off_plane + off_level * off_level) * m.area_px * width;
  }

  const double left = sides == Sides::Bent ? kLeftByBend : 1.0;
  if (state == State::Cut && left * m.limit * passed > kMostOff) return std::numeric_limits<double>::infinity();
  const double seen = m.mean * m.mean * width * width;
  const SidesOff off = sides_off(mesh, cell, state, left);
  error += kEdgeBound * seen * off.strips;
  // Where cells meet at displaced sides, a strip takes the neighbouring cell's irradiance.
  const double beside = m.on_plane ? 0.0 : m.range * std::min(off.shared_px / std::max(m.longest_px, 1e-6), 1.0);
  error += kShadeBound * beside * beside * m.area_px * width;
  if (is_dirty(mesh, cell)) error += seen * shadow_error(mesh, cell);
  const auto along_edges = [&](double by, double edges) { return seen * std::min(by * by, by) * edges * m.longest_px; };
  if (state == State::Cut)
    error += kEdgeBound * along_edges(left * m.limit * m.longest_px, iris_.is_picture() ? kPictureEdges : 1.0);
  if (cell.screen.part == ScreenPart::Varied && error < m.most &&
      !sees_by_parts(mesh, cell, m.longest_px)) {  // cells drawn in parts use no map
    if (!m.map_error) m.map_error = map_error(mesh, cell, m.longest_px);
    const double map_off = *m.map_error * m.longest_px;
    const double shown = map_off < kLittleOff_px ? kSeenOfLittle : 1.0;
    error += shown * along_edges(map_off, std::min(1.0, stop_size(mesh, cell) / (screen_->unit * m.longest_px)));
  }
  // Far above the frame's peak only the relative error counts.
  const double dimmed = passed * seen_share(m.mean, peak_);
  error = std::min(error, m.most) * dimmed * dimmed;
  if (m.longest_px < kShownLength_px || m.mean * passed * width < kFacetLevel * peak_) return error;
  const auto shown = [&](double off_px) { return cell_budget() * off_px * off_px; };
  if (state == State::Cut) error = std::max(error, shown(off.shared_px / kCorner_px));
  return sides_bend_ ? std::max(error, shown(off.alone_px / kSeam_px)) : error;
}

// Cells that share a side have the same corners on it: they leave no gap, and an edge that clips both is displaced only
// where it crosses the side. Next to a cell of another box, or to one that is drawn as triangles, sides overlap or
// leave gaps.
CellPainter::SidesOff CellPainter::sides_off(const Mesh& mesh, const Cell& cell, State state, double left) const {
  const bool triangles = is_dirty(mesh, cell) || (state == State::Cut && iris_.is_picture() && !screen_);
  SidesOff out;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = mesh.position(cell.corner[k]);
    const Vec2 c = mesh.position(cell.corner[(k + 1) % 4]);
    const double off_px = left * length(mesh.position(cell.side[k]) - (a + c) * 0.5);
    const bool shared = cell.shared[k] && !triangles;
    double& most_px = shared ? out.shared_px : out.alone_px;
    most_px = std::max(most_px, off_px);
    const double shown = !shared ? 1.0 : state == State::Cut ? kShownOfShared : 0.0;
    out.strips += shown * std::min(off_px * off_px, off_px) * length(c - a);
  }
  return out;
}

// The displacement of the lines that clip the cell when stop coordinates and heights at rims are taken as linear along
// its sides, as a fraction of the cell.
double CellPainter::limit_error(const Mesh& mesh, const Cell& cell) const {
  double largest = 0.0;
  const int first_rim = mesh.layout.rim(0);
  for (int f = screen_ ? first_rim : PatchLayout::kStop; f < mesh.layout.limits_end(); ++f) {
    const Mesh::Field& v = mesh.field(f);
    if (f >= first_rim && mesh.layout.is_obscuration(f - first_rim)) {
      largest = std::max(largest, obscuration_error(v, cell));
      continue;
    }
    float low = v[cell.corner[0]];
    float high = low;
    for (const std::size_t k : cell.corner) {
      low = std::min(low, v[k]);
      high = std::max(high, v[k]);
    }
    float lowest = std::min(low, v[cell.middle]);  // a rim may pass inside a cell whose corners are all beyond it
    for (const std::size_t k : cell.side) lowest = std::min(lowest, v[k]);
    if (f >= first_rim && (high <= 1.0F || lowest > 1.0F)) continue;
    double off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      off = std::max(off, std::abs(static_cast<double>(v[cell.side[k]]) -
                                   0.5 * (v[cell.corner[k]] + v[cell.corner[(k + 1) % 4]])));
    }
    // Neighbouring stop fields are the coordinates of one point: the larger of their changes is the scale of both.
    double change = high - low;
    if (f < first_rim) {
      const Mesh::Field& w = mesh.field((f - PatchLayout::kStop) % 2 == 0 ? f + 1 : f - 1);
      for (const std::size_t k : cell.corner)
        change = std::max(change, 2.0 * std::abs(static_cast<double>(w[k]) - w[cell.middle]));
    }
    if (change > 0.0) largest = std::max(largest, off / change);
    for (std::size_t k = 0; f >= first_rim && k < 4; ++k)
      largest = std::max(largest, off_crossing(v[cell.corner[k]], v[cell.side[k]], v[cell.corner[(k + 1) % 4]]));
  }
  return largest;
}

// The same displacement for an obscuration, whose edge curves more, so that the deviation in the middle counts too. The
// obscuration may begin and end inside the cell or within one side, where clipping along the outline misses it.
double CellPainter::obscuration_error(const Mesh::Field& v, const Cell& cell) {
  double low = v[cell.middle], off = 0.0, outline = v[cell.corner[0]], mean = 0.0;
  const auto bend = [&](std::size_t a, std::size_t b) { return std::abs(v[a] - 2.0 * v[cell.middle] + v[b]); };
  for (std::size_t k = 0; k < 4; ++k) {
    const double corner = v[cell.corner[k]], side = v[cell.side[k]];
    low = std::min({low, corner, side});
    outline = std::max({outline, corner, side});
    off = std::max(off, std::abs(side - 0.5 * (corner + v[cell.corner[(k + 1) % 4]])));
    mean += 0.25 * corner;
  }
  off = std::max(off, std::abs(v[cell.middle] - mean));
  const double rise = (bend(cell.side[1], cell.side[3]) + bend(cell.side[0], cell.side[2])) / 8.0;
  const double high = std::max(outline, static_cast<double>(v[cell.middle]));
  if (high + rise <= 1.0 || low > 1.0 || !(high > low)) return 0.0;
  return kObscurationBend * (outline > 1.0 ? off : high + rise - 1.0) / (high - low);
}

// The step along an arc for which chords miss it by no more pixels than their part of the budget allows; twice that
// distance costs up to 0.7 dB.
double CellPainter::arc_step(const Mesh& mesh, std::span<const CellCorner> corners, const Shade& shade) const {
  double reach = 0.0;
  Bounds b;
  for (const CellCorner& corner : corners) {
    b.add(mesh.position(corner.vertex));
    for (int f = PatchLayout::kStop; f < mesh.layout.rim(0); ++f) {
      const Mesh::Field& stop = mesh.field(f);
      reach = std::max(reach, std::abs(static_cast<double>(stop[corner.vertex]) - stop[corners[0].vertex]));
    }
  }
  const double longest = std::max(b.size().x, b.size().y);
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double seen = level * seen_share(level, peak_);
  const double most_px = level > kFacetLevel * peak_ ? kMostOfSeenChord_px : kMostOfChord_px;
  const double off_px = std::clamp(
      kChordShare * std::sqrt(cell_budget() / std::max(longest, 1.0)) / std::max(seen, 1e-300), 0.02, most_px);
  const double pixels_per_radius = longest / std::max(reach, 1e-9);
  return std::clamp(std::sqrt(8.0 * off_px / pixels_per_radius), 0.02, 0.8);
}

}  // namespace contrejour::inline internal::adaptive
