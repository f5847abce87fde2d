// SPDX-License-Identifier: Apache-2.0
// Draws cells whose light passes a stop pattern instead of the sharp iris. Where the pattern varies, points in the stop
// are polynomials of the pixel. Large cells are cut along the edges with fringes into strips and a uniform remainder.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/cells/bound_view.h"
#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // widths of pixels for which edges' tables are made
constexpr double kScreenDisc = 1.2;  // radius of a curved cell over its vertices' distance from its middle, in the stop
constexpr double kPixelReach = 0.75;  // pixels: slightly more than from a pixel's middle to its corners
constexpr double kExact = 1e-3;  // softness of the map from which a cell's error is measured, over the cell's size
constexpr double kOnePlace_px = 1.0;  // cells no longer than this are points to pixels
constexpr double kCoarse = 0.5;  // stop radii a pixel: four pixels or fewer cover the stop
constexpr double kPart = 0.5;  // stop radii, and
constexpr double kPart_px = 0.4;  // pixels, across a part of a small cell
constexpr double kEven = 5000.0;  // times the negligible level: differences between parts below this are ignored
constexpr double kWorthCutting_px = 400.0;  // area below which a cell is not cut, and all of its pixels are looked up

// The points at which the rays of a mesh's vertices cross the stop, in stop radii.
class StopPlaces {
 public:
  StopPlaces(const Mesh& mesh, int crossing, double unit)
      : x_(mesh.field(PatchLayout::kStop + 2 * crossing).data()),
        y_(mesh.field(PatchLayout::kStop + 2 * crossing + 1).data()), unit_(unit) {}
  [[nodiscard]] Vec2 at(std::size_t vertex) const { return Vec2{x_[vertex], y_[vertex]} * unit_; }

 private:
  const float *x_, *y_;
  double unit_;
};

}  // namespace

Vec2 CellPainter::stop_place(const Mesh& mesh, std::size_t vertex, int crossing) const {
  return StopPlaces(mesh, crossing, screen_unit_).at(vertex);
}

// The part of the stop pattern that a cell's last crossing of the stop covers.
screens::ScreenView CellPainter::view_of_screen(const Mesh& mesh, const Cell& cell) const {
  const int last = mesh.layout.crossings - 1;
  if (!screen_ || last < 0) return {ScreenPart::Level, 1.0};
  const StopPlaces stop(mesh, last, screen_unit_);
  const Vec2 middle = stop.at(cell.middle);
  double squared = 0.0;
  const auto hold = [&](std::size_t v) {
    const Vec2 from = stop.at(v) - middle;
    squared = std::max(squared, dot(from, from));
  };
  for (const std::size_t v : cell.corner) hold(v);
  for (const std::size_t v : cell.side) hold(v);
  double squared_px = 0.0;
  for (const std::size_t v : cell.corner) {
    const Vec2 from = mesh.position(v) - mesh.position(cell.middle);
    squared_px = std::max(squared_px, dot(from, from));
  }
  // The disc includes what a neighbouring pixel's look-up reaches: where a cell of a pixel is drawn through the
  // pattern, its neighbours must be, too.
  const double radius = std::sqrt(squared), per_px = radius / std::max(std::sqrt(squared_px), kPixelReach);
  screens::ScreenView view = screen_->over(middle, kScreenDisc * radius + kPixelReach * per_px);
  if (view.part == ScreenPart::Level && last > 0) view.part = ScreenPart::Varied;  // earlier crossings are sharp
  return view;
}

// Whether the light that passes the stop pattern is everywhere in the cell dimmer than `times` the negligible level.
bool CellPainter::is_dim(const Mesh& mesh, const Cell& cell, double times) const {
  return cell.screen.most * brightest(mesh, cell) < times * screen_->unseen;
}

double CellPainter::brightest(const Mesh& mesh, const Cell& cell) {
  float brightest = mesh.brightness[cell.middle];
  for (const std::size_t v : cell.corner) brightest = std::max(brightest, mesh.brightness[v]);
  for (const std::size_t v : cell.side) brightest = std::max(brightest, mesh.brightness[v]);
  return static_cast<double>(brightest);
}

double CellPainter::stop_size(const Mesh& mesh, const Cell& cell) const {
  const StopPlaces stop(mesh, mesh.layout.crossings - 1, screen_unit_);
  const auto at = [&](std::size_t v) { return stop.at(v); };
  return std::max(length(at(cell.corner[2]) - at(cell.corner[0])), length(at(cell.corner[3]) - at(cell.corner[1])));
}

StopMap CellPainter::stop_map(const Mesh& mesh, const Cell& cell, double softness_px) const {
  const auto series = [&](const auto& at) {
    const std::array corner{at(cell.corner[0]), at(cell.corner[1]), at(cell.corner[2]), at(cell.corner[3])};
    if (cell.size == 1) return CellSeries::of_corners(corner);  // there are no vertices between the corners
    return CellSeries::of(corner, {at(cell.side[0]), at(cell.side[1]), at(cell.side[2]), at(cell.side[3])},
                          at(cell.middle));
  };
  return stop_map(mesh, softness_px, series);
}

StopMap CellPainter::stop_map(const Mesh& mesh, const std::array<std::size_t, 3>& triangle) const {
  return stop_map(mesh, kSoft_px, [&](const auto& at) {
    return CellSeries::of_triangle({at(triangle[0]), at(triangle[1]), at(triangle[2])});
  });
}

template <class SeriesOf>
StopMap CellPainter::stop_map(const Mesh& mesh, double softness_px, const SeriesOf& series_of) const {
  std::array<CellSeries, kMaxStopCrossings> stop;
  for (int c = 0; c < mesh.layout.crossings; ++c)
    stop[static_cast<std::size_t>(c)] =
        series_of([places = StopPlaces(mesh, c, screen_unit_)](std::size_t v) { return places.at(v); });
  return {series_of([&](std::size_t v) { return mesh.position(v) + mesh.origin_px; }),
          {stop.data(), static_cast<std::size_t>(mesh.layout.crossings)},
          softness_px};
}

// The largest error of the polynomial map from pixels to stop points at the cell's vertices, as a fraction of the cell.
double CellPainter::map_error(const Mesh& mesh, const Cell& cell, double longest_px) const {
  const double size = stop_size(mesh, cell);
  if (!(size > 0.0)) return 0.0;
  const StopMap map = stop_map(mesh, cell, kExact * longest_px);
  double squared = 0.0;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    const StopPlaces stop(mesh, c, screen_unit_);
    const auto check = [&](std::size_t v) {
      const Vec2 off = map.place(mesh.position(v) + mesh.origin_px, static_cast<std::size_t>(c)) - stop.at(v);
      squared = std::max(squared, dot(off, off));
    };
    for (const std::size_t v : cell.corner) check(v);
    for (const std::size_t v : cell.side) check(v);
  }
  return std::sqrt(squared) / size;
}

// The table of fringes for pixels of about this width.
const EdgeTable& CellPainter::table_for(double width) {
  const int octave = static_cast<int>(std::lround(kWidthsPerOctave * std::log2(std::max(width, 1e-9))));
  const auto [at, is_new] = tables_.try_emplace(std::pair(screen_.get(), octave), nullptr);
  if (is_new) {
    out_.tables.push_back(std::make_shared<const EdgeTable>(*screen_, std::exp2(octave / kWidthsPerOctave)));
    at->second = out_.tables.back().get();
  }
  return *at->second;
}

Vec2 CellPainter::CellParts::place(std::size_t part, Vec2 in_part) const {
  const Vec2 first{static_cast<double>(part % across), static_cast<double>(part / across)};
  return (first + in_part) * (1.0 / static_cast<double>(across));
}

Vec2 CellPainter::CellParts::corner(std::size_t part, std::size_t which) const {
  return place(part, {which == 1 || which == 2 ? 1.0 : 0.0, which >= 2 ? 1.0 : 0.0});
}

Vec2 CellPainter::CellParts::between(const std::array<Vec2, 4>& corner, Vec2 uv) {
  return (corner[0] * (1.0 - uv.x) + corner[1] * uv.x) * (1.0 - uv.y) +
         (corner[3] * (1.0 - uv.x) + corner[2] * uv.x) * uv.y;
}

CellPainter::Flux CellPainter::CellParts::mean() const {
  Flux sum{};
  for (const Flux& one : passed())
    for (std::size_t c = 0; c < 3; ++c) sum[c] += one[c] / static_cast<double>(count());
  return sum;
}

// Whether the parts differ by more than `room` in any channel.
bool CellPainter::CellParts::are_uneven(double room) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [least, most] = std::ranges::minmax(passed(), {}, [&](const Flux& one) { return one[c]; });
    if (most[c] - least[c] > room) return true;
  }
  return false;
}

// Whether the transmittances of a cell's parts differ visibly.
bool CellPainter::are_uneven(const Mesh& mesh, const Cell& cell, const CellParts& parts) const {
  const double level = brightest(mesh, cell);
  return parts.are_uneven(kEven * screen_->unseen / std::max(level * seen_share(level, peak_), 1e-300));
}

// Whether pixels are too far apart to look up the pattern: a pixel's centre may lie outside the cell, and its stop
// point far from all points that the cell's light crosses.
bool CellPainter::sees_by_parts(const Mesh& mesh, const Cell& cell, double longest_px) const {
  return longest_px < kOnePlace_px || (longest_px < kSmall_px && stop_size(mesh, cell) > kCoarse * longest_px);
}

std::size_t CellPainter::parts_across(const Mesh& mesh, const Cell& cell, double longest_px) const {
  const double finest = std::max(longest_px / kPart_px, stop_size(mesh, cell) / kPart);
  return static_cast<std::size_t>(
      std::clamp(std::ceil(finest), 0.0 + CellParts::kFewestAcross, 0.0 + CellParts::kMostAcross));
}

CellPainter::CellParts CellPainter::parts_of(const Mesh& mesh, const Cell& cell, std::size_t across) const {
  CellParts parts;
  parts.across = across;
  const auto crossings = static_cast<std::size_t>(mesh.layout.crossings);
  std::array<std::array<Vec2, 4>, kMaxStopCrossings> corner;
  std::array<StopPlace, kMaxStopCrossings> places;
  for (std::size_t c = 0; c < crossings; ++c) {
    const StopPlaces stop(mesh, static_cast<int>(c), screen_unit_);
    for (std::size_t k = 0; k < 4; ++k) corner[c][k] = stop.at(cell.corner[k]);
    const double area = 0.5 * std::abs(cross(corner[c][2] - corner[c][0], corner[c][3] - corner[c][1]));
    places[c].width = std::sqrt(area) / static_cast<double>(parts.across);
  }
  for (std::size_t k = 0; k < parts.count(); ++k) {
    for (std::size_t c = 0; c < crossings; ++c) places[c].at = CellParts::between(corner[c], parts.middle(k));
    parts.room[k] = screen_->share({places.data(), crossings});
  }
  return parts;
}

// One look-up averages over a square in the stop as large as the pixel's image there, which is not a square. The error
// is a fraction of the fringes that are as fine as pixels, and falls as the square of the number of look-ups across a
// pixel. Fringes along edges are fainter the finer they are.
int CellPainter::looks_across_pixel(const Shade& shade, double passed, const StopMap& map) const {
  constexpr double kMost = 6.0;
  constexpr double kOneServes = 8000.0;  // times the negligible level: below, one look-up is enough; found by measuring
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double fineness = screen_->edges != nullptr ? std::min(1.0, map.width() / screen_->unit) : 1.0;
  const double seen = level * seen_share(level, peak_) * passed * fineness;
  const double room = kOneServes * screen_->unseen;
  return room > 0.0 ? static_cast<int>(std::lround(std::clamp(std::sqrt(seen / room), 1.0, kMost))) : 1;
}

// All pixels of a polygon look up the pattern. A large polygon is first clipped to the bounding polygon of a pattern's
// visible light. Behind edges' fringes straight lines cut off a part along each edge that has fringes there; the
// remainder is uniform.
void CellPainter::draw_screened(std::span<const Corner> polygon, double area_px, const Shade& shade, const StopMap& map,
                                int looks) {
  const bool large = area_px >= kWorthCutting_px;
  const double room = map.bend();  // cuts are straight lines, the map is not linear
  rest_.place(polygon, map);
  if (screen_->edges == nullptr || map.crossings() > 1) {
    for (std::size_t k = 0; large && screen_->pattern && k < screens::PatternHull::kLines; ++k)
      rest_.keep_within({screens::PatternHull::normals()[k], screen_->hull.most(k) + room}, map);
    if (!rest_.is_empty())
      out_.add(points_of(rest_.corners()), shade,
               Screened{.map = map.narrowed(looks), .screen = screen_.get(), .looks = looks}, {});
    return;
  }
  const EdgeTable& table = table_for(map.width() / looks);
  if (!large || table.iris().is_picture()) return add_fringed(rest_.corners(), shade, map, looks, table);
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest_.is_empty()) return;
    const BoundView view(bound, rest_.corners());
    rest_.keep_within({view.normal(), view.outer() + table.dark_beyond() + room}, map);
  }
  const auto draw_beyond = [&](const HalfPlane& kept) {
    strip_.take(rest_);
    strip_.keep_within({kept.normal * -1.0, -kept.most}, map);
    if (strip_.is_empty()) return;
    rest_.keep_within(kept, map);
    add_fringed(strip_.corners(), shade, map, looks, table);
  };
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest_.is_empty()) return;
    const BoundView view(bound, rest_.corners());
    const Strip level = view.deeper_than(table.level_within() + room);
    if (level.is_empty()) return add_fringed(rest_.corners(), shade, map, looks, table);
    draw_beyond({view.normal(), level.most});
    if (std::isfinite(level.least)) draw_beyond({view.normal() * -1.0, -level.least});
  }
  if (!rest_.is_empty()) out_.add(points_of(rest_.corners()), shade);
}

void CellPainter::add_fringed(std::span<const PlacedCorner> polygon, const Shade& shade, const StopMap& map, int looks,
                              const EdgeTable& table) {
  active_.clear();
  const auto& bounds = table.iris().bounds();
  for (std::size_t k = 0; k < bounds.size() && !table.iris().is_picture(); ++k) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const PlacedCorner& c : polygon) nearest = std::max(nearest, bounds[k].distance(c.stop));
    // Distances are convex: inside the polygon none exceeds those at the corners, except where pixels reach beyond it.
    if (nearest + 2.0 * map.pixel_reach() + map.bend() > -table.level_within())
      active_.push_back(static_cast<std::uint16_t>(k));
  }
  out_.add(points_of(polygon), shade,
           Screened{.map = map.narrowed(looks), .screen = screen_.get(), .edges = &table, .looks = looks}, active_);
}

}  // namespace contrejour::inline internal::adaptive
