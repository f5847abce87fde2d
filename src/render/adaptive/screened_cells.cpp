// Cells whose light passes a screen instead of the sharp iris: where it varies they are drawn as triangles, over which
// places in the stop are linear, and cut into strips along the edges that bring fringes and what is level between them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/cell_painter.h"

namespace contrejour::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // of edges' tables
constexpr double kScreenDisc = 1.2;  // of a cell's distance from its middle in the stop, for cells that bend
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
  std::vector<Corner> out;
  const auto value = [&](const Corner& c) { return dot(kept.normal, map.place(c.position)) - kept.most; };
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

// Over the disc about a cell's crossings of the stop.
ScreenPart CellPainter::screen_part(const Mesh& mesh, const Cell& cell) const {
  const int last = mesh.layout.crossings - 1;
  if (last < 0) return ScreenPart::Level;
  const Vec2 middle = stop_place(mesh, cell.middle, last);
  double radius = 0.0;
  for (const std::size_t v : cell.corner) radius = std::max(radius, length(stop_place(mesh, v, last) - middle));
  for (const std::size_t v : cell.side) radius = std::max(radius, length(stop_place(mesh, v, last) - middle));
  const ScreenPart part = screen_->over(middle, kScreenDisc * radius);
  return part == ScreenPart::Level && last > 0 ? ScreenPart::Varied : part;
}

double CellPainter::stop_size(const Mesh& mesh, const Cell& cell) const {
  const int last = mesh.layout.crossings - 1;
  const auto at = [&](std::size_t v) { return stop_place(mesh, v, last); };
  return std::max(length(at(cell.corner[2]) - at(cell.corner[0])), length(at(cell.corner[3]) - at(cell.corner[1])));
}

// How far the stop's places at a cell's middle are off the diagonals' middles, as a share of the cell.
double CellPainter::twist(const Mesh& mesh, const Cell& cell) const {
  double largest = 0.0;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    const auto at = [&](std::size_t v) { return stop_place(mesh, v, c); };
    const Vec2 middle = at(cell.middle);
    const double size =
        length(at(cell.corner[2]) - at(cell.corner[0])) + length(at(cell.corner[3]) - at(cell.corner[1]));
    for (std::size_t k = 0; k < 2; ++k) {
      const double off = length((at(cell.corner[k]) + at(cell.corner[k + 2])) * 0.5 - middle);
      if (size > 0.0) largest = std::max(largest, 2.0 * off / size);
    }
  }
  return largest;
}

StopMap CellPainter::stop_map(const Mesh& mesh, std::span<const std::size_t> corners) const {
  std::array<StopMap::Corner, 3> c;
  for (std::size_t k = 0; k < 3; ++k) {
    c[k].pixel = mesh.position(corners[k]) + mesh.origin_px;
    for (int crossing = 0; crossing < mesh.layout.crossings; ++crossing)
      c[k].stop[static_cast<std::size_t>(crossing)] = stop_place(mesh, corners[k], crossing);
  }
  return {c, mesh.layout.crossings};
}

// For pixels of about that width.
const EdgeTable& CellPainter::table_for(double width) {
  const int octave = static_cast<int>(std::lround(kWidthsPerOctave * std::log2(std::max(width, 1e-9))));
  const auto [at, is_new] = tables_.try_emplace(octave, nullptr);
  if (is_new) {
    out_.tables.push_back({screen_, std::make_shared<const EdgeTable>(*screen_, std::exp2(octave / kWidthsPerOctave))});
    at->second = out_.tables.back().table.get();
  }
  return *at->second;
}

// The parts of a triangle's polygon along each edge that brings fringes there, cut off by straight lines, and the rest,
// which is level.
void CellPainter::draw_fringed(std::span<const Corner> polygon, const Shade& shade, const Flux& flux,
                               const StopMap& map) {
  const EdgeTable& table = table_for(map.width());
  if (table.iris().is_picture()) return add_fringed(polygon, shade, map, table);
  std::vector<Corner> rest(polygon.begin(), polygon.end()), strip;
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest.size() < 3) return;
    const EdgeLine line = line_along(bound, rest, map);
    keep_within(rest, map, {line.normal, line.outer + table.dark_beyond()});
    strip = rest;
    keep_within(strip, map, {line.normal * -1.0, table.level_within() - line.inner});
    if (strip.size() < 3) continue;
    keep_within(rest, map, {line.normal, line.inner - table.level_within()});
    add_fringed(strip, shade, map, table);
  }
  draw_part(rest, shade, flux, true);
}

void CellPainter::add_fringed(std::span<const Corner> polygon, const Shade& shade, const StopMap& map,
                              const EdgeTable& table) {
  active_.clear();
  const auto& bounds = table.iris().bounds();
  for (std::size_t k = 0; k < bounds.size() && !table.iris().is_picture(); ++k) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const Corner& c : polygon) nearest = std::max(nearest, bounds[k].distance(map.place(c.position)));
    // Distances are convex: none within is larger than at the corners, but for pixels that reach beyond.
    if (nearest + map.width() > -table.level_within()) active_.push_back(static_cast<std::uint16_t>(k));
  }
  points_.clear();
  for (const Corner& c : polygon)
    points_.push_back({static_cast<float>(c.position.x), static_cast<float>(c.position.y)});
  const Vec2 origin = map.place({0.0, 0.0});
  out_.add(points_, shade,
           PolygonList::Fringed{&table, origin, map.place({1.0, 0.0}) - origin, map.place({0.0, 1.0}) - origin, 0, 0},
           active_);
}

// Two triangles, over each of which places in the stop are linear.
void CellPainter::draw_screened(const Mesh& mesh, const Cell& cell, State state, const Shade& shade, const Flux& flux) {
  const Flux half{0.5 * flux[0], 0.5 * flux[1], 0.5 * flux[2]};
  for (const auto& t : {std::array{cell.corner[0], cell.corner[1], cell.corner[2]},
                        std::array{cell.corner[0], cell.corner[2], cell.corner[3]}}) {
    const std::array<CellCorner, 3> corners{{{t[0], {0, 0}}, {t[1], {1, 0}}, {t[2], {1, 1}}}};
    const StopMap map = stop_map(mesh, t);
    draw_polygon(mesh, state, shade, half, corners, &map);
  }
}

}  // namespace contrejour::adaptive
