// Cells whose light passes a screen instead of the sharp iris: where it varies, places in the stop are polynomials of
// the pixel; large cells are cut into strips along the edges that bring fringes and what is level between them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/cell_painter.h"
#include "render/adaptive/cell_shape.h"

namespace contrejour::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // of edges' tables
constexpr double kScreenDisc = 1.2;  // of a cell's distance from its middle in the stop, for cells that bend
constexpr double kExact = 1e-3;   // of a cell's size, for maps to be judged by
constexpr double kWorthCutting_px = 400.0;  // of area: smaller cells are looked up all over
constexpr double kSagittaRoom = 0.5;  // of an arc's, for circles about the same centre with a smaller radius

struct HalfPlane {  // normal . p <= most
  Vec2 normal;
  double most = 0.0;
};

// Across a bound, straight: normal . p is at most `outer` on the bound's inner side, and at most `inner` nowhere but
// there, as far as some polygon sees it.
struct EdgeLine {
  Vec2 normal;
  double outer = 0.0, inner = 0.0;
};

EdgeLine line_along(const IrisBound& bound, std::span<const Corner> polygon, const StopMap& map) {
  if (bound.straight()) return {bound.normal, bound.apothem, bound.apothem};
  Vec2 middle{};
  for (const Corner& c : polygon) middle = middle + map.place(c.position) * (1.0 / static_cast<double>(polygon.size()));
  const Vec2 from = middle - bound.centre;
  const double far = length(from);
  double sideways = 0.0;
  const Vec2 normal = far > 0.0 ? from * (1.0 / far) : Vec2{1.0, 0.0};
  for (const Corner& c : polygon)
    sideways = std::max(sideways, std::abs(cross(normal, map.place(c.position) - bound.centre)));
  const double reach = dot(normal, bound.centre) + bound.radius;
  const double sagitta = bound.radius - std::sqrt(std::max(0.0, bound.radius * bound.radius - sideways * sideways));
  return {normal, reach, reach - sagitta * (1.0 + kSagittaRoom)};
}

void keep_within(std::vector<Corner>& polygon, const StopMap& map, const HalfPlane& kept) {
  const auto value = [&](const Corner& c) { return dot(kept.normal, map.place(c.position)) - kept.most; };
  if (std::all_of(polygon.begin(), polygon.end(), [&](const Corner& c) { return value(c) <= 0.0; })) return;
  std::vector<Corner> out;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& a = polygon[k];
    const Corner& b = polygon[k + 1 == polygon.size() ? 0 : k + 1];
    const double fa = value(a), fb = value(b);
    if (fa <= 0.0) out.push_back(a);
    if ((fa <= 0.0) == (fb <= 0.0)) continue;
    Corner c;
    const double t = fa / (fa - fb);
    c.position = a.position + (b.position - a.position) * t;
    c.uv = a.uv + (b.uv - a.uv) * t;
    out.push_back(c);
  }
  polygon.swap(out);
}

}  // namespace

Vec2 CellPainter::stop_place(const Mesh& mesh, std::size_t vertex, int crossing) const {
  const int field = PatchLayout::kStop + 2 * crossing;
  return Vec2{mesh.field(field)[vertex], mesh.field(field + 1)[vertex]} * screen_unit_;
}

// About a cell's last crossings of the stop.
ScreenView CellPainter::view_of_screen(const Mesh& mesh, const Cell& cell) const {
  const int last = mesh.layout.crossings - 1;
  if (!screen_ || last < 0) return {ScreenPart::Level, 1.0};
  const Vec2 middle = stop_place(mesh, cell.middle, last);
  double radius = 0.0;
  for (const auto& vertices : {cell.corner, cell.side})
    for (const std::size_t v : vertices) radius = std::max(radius, length(stop_place(mesh, v, last) - middle));
  ScreenView view = screen_->over(middle, kScreenDisc * radius);
  if (view.part == ScreenPart::Level && last > 0) view.part = ScreenPart::Varied;  // earlier crossings are sharp
  return view;
}

// Whether what passes the screen is too dim all over the cell.
bool CellPainter::is_unseen(const Mesh& mesh, const Cell& cell) const {
  float brightest = mesh.brightness[cell.middle];
  for (const std::size_t v : cell.corner) brightest = std::max(brightest, mesh.brightness[v]);
  for (const std::size_t v : cell.side) brightest = std::max(brightest, mesh.brightness[v]);
  return cell.screen.most * brightest < screen_->unseen;
}

double CellPainter::stop_size(const Mesh& mesh, const Cell& cell) const {
  const int last = mesh.layout.crossings - 1;
  const auto at = [&](std::size_t v) { return stop_place(mesh, v, last); };
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
    stop[static_cast<std::size_t>(c)] = series_of([&](std::size_t v) { return stop_place(mesh, v, c); });
  return {series_of([&](std::size_t v) { return mesh.position(v) + mesh.origin_px; }),
          {stop.data(), static_cast<std::size_t>(mesh.layout.crossings)},
          softness_px};
}

// How far places in the stop are off where they are polynomials of the pixel, as a share of the cell.
double CellPainter::map_error(const Mesh& mesh, const Cell& cell, double longest_px) const {
  const double size = stop_size(mesh, cell);
  if (!(size > 0.0)) return 0.0;
  const StopMap map = stop_map(mesh, cell, kExact * longest_px);
  double most = 0.0;
  const auto check = [&](std::size_t v) {
    const Vec2 pixel = mesh.position(v) + mesh.origin_px;
    for (int c = 0; c < mesh.layout.crossings; ++c)
      most = std::max(most, length(map.place(pixel, static_cast<std::size_t>(c)) - stop_place(mesh, v, c)));
  };
  for (const std::size_t v : cell.corner) check(v);
  for (const std::size_t v : cell.side) check(v);
  return most / size;
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

// What passes to a cell so small that a pixel sees all of it at once.
std::array<double, 3> CellPainter::passed_to(const Mesh& mesh, const Cell& cell) const {
  std::array<StopPlace, kMaxStopCrossings> places;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    const auto at = [&](std::size_t v) { return stop_place(mesh, v, c); };
    const double twice_area = cross(at(cell.corner[2]) - at(cell.corner[0]), at(cell.corner[3]) - at(cell.corner[1]));
    places[static_cast<std::size_t>(c)] = {at(cell.middle), std::sqrt(0.5 * std::abs(twice_area))};
  }
  return screen_->share({places.data(), static_cast<std::size_t>(mesh.layout.crossings)});
}

// All of a polygon's pixels look up what passes. A large one behind a pattern: as far as that is worth drawing. Behind
// edges' fringes: the parts along each edge that brings any there, cut off by straight lines; the rest is level.
void CellPainter::draw_screened(std::span<const Corner> polygon, double area_px, const Shade& shade, const Flux& flux,
                                const StopMap& map) {
  const bool large = area_px >= kWorthCutting_px;
  const double room = map.bend();  // cuts are straight, places are not
  if (screen_->edges == nullptr || map.crossings() > 1) {
    std::vector<Corner> seen;
    if (large && screen_->pattern) {
      seen.assign(polygon.begin(), polygon.end());
      for (std::size_t k = 0; k < screens::PatternHull::kLines; ++k)
        keep_within(seen, map, {screens::PatternHull::normals()[k], screen_->hull.most(k) + room});
      polygon = seen;
    }
    if (polygon.size() > 2) out_.add(points_of(polygon), shade, Screened{map, screen_.get()}, {});
    return;
  }
  const EdgeTable& table = table_for(map.width());
  if (!large || table.iris().is_picture()) return add_fringed(polygon, shade, map, table);
  std::vector<Corner> rest(polygon.begin(), polygon.end()), strip;
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest.size() < 3) return;
    const EdgeLine line = line_along(bound, rest, map);
    keep_within(rest, map, {line.normal, line.outer + table.dark_beyond() + room});
  }
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest.size() < 3) return;
    const EdgeLine line = line_along(bound, rest, map);
    strip = rest;
    keep_within(strip, map, {line.normal * -1.0, table.level_within() + room - line.inner});
    if (strip.size() < 3) continue;
    keep_within(rest, map, {line.normal, line.inner - table.level_within() - room});
    add_fringed(strip, shade, map, table);
  }
  draw_part(rest, shade, flux, true, {});
}

void CellPainter::add_fringed(std::span<const Corner> polygon, const Shade& shade, const StopMap& map,
                              const EdgeTable& table) {
  active_.clear();
  const auto& bounds = table.iris().bounds();
  for (std::size_t k = 0; k < bounds.size() && !table.iris().is_picture(); ++k) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const Corner& c : polygon) nearest = std::max(nearest, bounds[k].distance(map.place(c.position)));
    // Distances are convex: none within is larger than at the corners, but for pixels that reach beyond.
    if (nearest + map.width() + map.bend() > -table.level_within()) active_.push_back(static_cast<std::uint16_t>(k));
  }
  out_.add(points_of(polygon), shade, Screened{map, screen_.get(), &table}, active_);
}

}  // namespace contrejour::adaptive
