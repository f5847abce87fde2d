// What drawing a cell as one polygon gets wrong: as squared errors, summed over its pixels, that budgets are held
// against, and how finely arcs are to be cut.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::adaptive {
namespace {

constexpr double kPixel = 1.0;       // area below which a cell is not seen but for its flux
constexpr double kPictureEdges = 6.0;  // that cut a cell, as long as it is, where a picture is the iris
// Found by measuring what doubling each does to errors and to the number of cells.
constexpr double kShadeBound = 4.0;  // the irradiance is linear over the cell in pixels, not in shares of it
constexpr double kEdgeBound = 2.0;  // what edges are off is all seen, where levels are off by less than their bounds
constexpr double kFoldBound = 0.5;  // of a fold's flux, that is out of place
constexpr double kShownOfShared =
    0.3;  // of how far sides that cells share are off, where edges cut them: found likewise
constexpr double kMostBend = 0.04;  // of a cell, that what cuts it may be off
constexpr double kMostOff = 0.01;   // likewise, of what corners in the middles of its sides leave of that
constexpr double kLeftByBend = 0.25;  // of a curve's deviation from its chord, where a corner in its middle bends it
constexpr double kChordShare = 0.5;  // of a cell's error, that chords in place of an arc may make
// What chords may miss their arc by, whatever the budget: of ghosts as bright as kFacetLevel their corners show.
constexpr double kMostOfChord_px = 0.5, kMostOfSeenChord_px = 0.25;
constexpr double kObscurationBend = 3.0;  // its edge goes on bending where that corner is: found by measuring
// Ripples in their place to less than so many pixels: they are as broad as that or fade, so that this much of their
// error shows. Found by measuring; all displacements alike would cost a bright spot 1 dB.
constexpr double kLittleOff_px = 0.5, kSeenOfLittle = 0.1;
// Of a cell that large, and so bright beside the peak: a plane that is farther off shows as a facet, however little it
// is of the peak.
constexpr double kFacet = 0.02, kFacet_px = 400.0, kFacetLevel = 2e-4;
// Of ghosts that bright, and cells that long: gaps this wide show as lines, where sides bend for no reason of the
// image's beside cells of another box; where an edge crosses a side so far off its place it has a corner.
constexpr double kShownLength_px = 8.0, kSeam_px = 0.07, kCorner_px = 1.0;

// Mean square of what a plane through a cell's nine vertices, row by row, leaves of their values.
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

// How far from where a parabola through the values at a side's ends and middle is 1 a line between its ends is, as a
// share of the side; 0 where it does not cross. Beside what fails heights rise so steeply that their mean slope says
// little.
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
  // Its whole flux out of place within its bounds: no cell can do worse.
  const double flux = std::abs(mesh.brightness[cell.middle] * mesh.area[cell.middle]) * cell.size * cell.size;
  // Moved by a quarter of a size below a pixel, an eighth of its square is what pixels see.
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
      m.whole = std::numeric_limits<double>::infinity();  // or light would be lost unseen
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

// What drawing the cell as one polygon with a linear irradiance would get wrong, squared, over its pixels.
double CellPainter::squared_error(const Mesh& mesh, const Cell& cell, CellMeasure& m, State state, Sides sides) const {
  const double passed = cell.screen.most;
  if (passed == 0.0) return 0.0;
  if (m.whole) return passed * passed * *m.whole;
  const double width =
      std::min(1.0, m.area_px / std::max(m.longest_px, 1e-6));  // a sliver's flux is spread over a pixel
  double error = 0.0;
  if (!m.on_plane) {  // what is drawn has the flux over the polygon's area for its mean
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
  // Where cells meet off their place, irradiance is taken from beside its own.
  const double beside = m.on_plane ? 0.0 : m.range * std::min(off.shared_px / std::max(m.longest_px, 1e-6), 1.0);
  error += kShadeBound * beside * beside * m.area_px * width;
  if (is_dirty(mesh, cell)) error += seen * shadow_error(mesh, cell);
  const auto along_edges = [&](double by, double edges) { return seen * std::min(by * by, by) * edges * m.longest_px; };
  if (state == State::Cut)
    error += kEdgeBound * along_edges(left * m.limit * m.longest_px, iris_.is_picture() ? kPictureEdges : 1.0);
  if (cell.screen.part == ScreenPart::Varied && error < m.most &&
      !sees_by_parts(mesh, cell, m.longest_px)) {  // soft ones
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

// What a cell shares its sides with has the same corners there: nothing is left between them, and of edges that cut
// both only the ends are off. Beside a cell of another box, or one that is drawn as triangles, sides overlap or leave
// gaps.
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

// How far the lines that cut the cell are off when stop coordinates and rims are taken as linear along its sides, as
// a share of the cell.
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
    // Neighbouring stop fields are one point's coordinates: the larger change is the scale of both.
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

// Likewise, of an obscuration, whose edge bends more: what the middle is off counts, too. It may begin and end inside
// the cell, or within one side: lines along the outline find nothing of it then.
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

// Chords of an arc that miss it by no more pixels than their share of the budget allows; twice that costs up to 0.7 dB.
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

}  // namespace contrejour::adaptive
