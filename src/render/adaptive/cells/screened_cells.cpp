// Cells whose light passes a screen instead of the sharp iris: where it varies, places in the stop are polynomials of
// the pixel; large cells are cut into strips along the edges that bring fringes and what is level between them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/cells/bound_view.h"
#include "render/adaptive/cells/cell_painter.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/cells/frame_error.h"

namespace contrejour::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // of edges' tables
constexpr double kScreenDisc = 1.2;  // of a cell's distance from its middle in the stop, for cells that bend
constexpr double kPixelReach = 0.75;  // pixels, from a pixel's middle to its corners
constexpr double kExact = 1e-3;   // of a cell's size, for maps to be judged by
constexpr double kOnePlace_px = 1.0;  // a cell no longer is a point to pixels
constexpr double kCoarse = 0.5;   // stop radii a pixel: they see all of the stop in four or fewer
constexpr double kPart = 0.5;     // stop radii, and
constexpr double kPart_px = 0.4;  // pixels, across a part of a small cell
constexpr double kEven = 5000.0;  // times what pixels may miss: parts that differ by less are not told apart
constexpr double kWorthCutting_px = 400.0;  // of area: smaller cells are looked up all over

// A crossing of the stop at a mesh's vertices, stop radii.
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

// About a cell's last crossings of the stop.
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
  // Its pixels see what is beside it: what one cell of a pixel is drawn by its neighbours have to be drawn by, too.
  const double radius = std::sqrt(squared), per_px = radius / std::max(std::sqrt(squared_px), kPixelReach);
  screens::ScreenView view = screen_->over(middle, kScreenDisc * radius + kPixelReach * per_px);
  if (view.part == ScreenPart::Level && last > 0) view.part = ScreenPart::Varied;  // earlier crossings are sharp
  return view;
}

// Whether what passes the screen is nowhere in the cell brighter than so many times what is not seen.
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
    if (cell.size == 1) return CellSeries::of_corners(corner);  // that is all there is
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

// How far places in the stop are off where they are polynomials of the pixel, as a share of the cell.
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

// For pixels of about that width.
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

// So that it shows where in the cell its light is.
bool CellPainter::CellParts::are_uneven(double room) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [least, most] = std::ranges::minmax(passed(), {}, [&](const Flux& one) { return one[c]; });
    if (most[c] - least[c] > room) return true;
  }
  return false;
}

// Whether more of its light passes one part of a cell than another, as far as that is seen.
bool CellPainter::are_uneven(const Mesh& mesh, const Cell& cell, const CellParts& parts) const {
  const double level = brightest(mesh, cell);
  return parts.are_uneven(kEven * screen_->unseen / std::max(level * seen_share(level, peak_), 1e-300));
}

// Where pixels are too far apart to look up what passes: their middles may lie outside the cell, where its light does
// not go, and see a place of the stop far from all of its own.
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

// One look-up stands for a square in the stop as large as the pixel's image there, which is no square; that is off by a
// part of the ripples that are as fine as pixels. Many look-ups into parts of the pixel are off by less as the square
// of how many there are across it. Edges' ripples are fainter the finer they are.
int CellPainter::looks_across_pixel(const Shade& shade, double passed, const StopMap& map) const {
  constexpr double kMost = 6.0;
  constexpr double kOneServes = 8000.0;  // times what pixels may miss; found by measuring
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double fineness = screen_->edges != nullptr ? std::min(1.0, map.width() / screen_->unit) : 1.0;
  const double seen = level * seen_share(level, peak_) * passed * fineness;
  const double room = kOneServes * screen_->unseen;
  return room > 0.0 ? static_cast<int>(std::lround(std::clamp(std::sqrt(seen / room), 1.0, kMost))) : 1;
}

// All of a polygon's pixels look up what passes. A large one behind a pattern: as far as that is worth drawing. Behind
// edges' fringes: the parts along each edge that brings any there, cut off by straight lines; the rest is level.
void CellPainter::draw_screened(std::span<const Corner> polygon, double area_px, const Shade& shade, const StopMap& map,
                                int looks) {
  const bool large = area_px >= kWorthCutting_px;
  const double room = map.bend();  // cuts are straight, places are not
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
    // Distances are convex: none within is larger than at the corners, but for pixels that reach beyond.
    if (nearest + 2.0 * map.pixel_reach() + map.bend() > -table.level_within())
      active_.push_back(static_cast<std::uint16_t>(k));
  }
  out_.add(points_of(polygon), shade,
           Screened{.map = map.narrowed(looks), .screen = screen_.get(), .edges = &table, .looks = looks}, active_);
}

}  // namespace contrejour::adaptive
