// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/cell_painter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kSliver = 1e-3;     // pixels: mean width below which a polygon is a line
constexpr double kUnseenDetail = 0.3;  // pixels: details of a picture as the iris that are not visible
constexpr double kSpeck = 0.05;      // pixels: a polygon no longer than this is a point
constexpr int kMostPoints = 256;     // points that represent a line, at most

}  // namespace

void CellPainter::dim(Shade& shade, Flux& flux, const Flux& share) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto times = static_cast<float>(share[c]);
    shade.value[c] *= times;
    shade.along_x[c] *= times;
    shade.along_y[c] *= times;
    flux[c] *= share[c];
  }
}

CellPainter::Shape CellPainter::shape_of(const Mesh& mesh, const Cell& cell, Sides sides) {
  constexpr std::array<Vec2, 4> kCorner{Vec2{0, 0}, Vec2{1, 0}, Vec2{1, 1}, Vec2{0, 1}};
  constexpr std::array<Vec2, 4> kSide{Vec2{0.5, 0}, Vec2{1, 0.5}, Vec2{0.5, 1}, Vec2{0, 0.5}};
  Shape out;
  for (std::size_t k = 0; k < 4; ++k) {
    out.add(CellCorner::at_vertex(mesh, cell.corner[k], kCorner[k]));
    if (sides == Sides::Bent) out.add(CellCorner::at_vertex(mesh, cell.side[k], kSide[k]));
  }
  return out;
}

CellPainter::CellLevel CellPainter::cell_level(const Mesh& mesh, const Cell& cell, int weight) {
  const Mesh::Field& w = mesh.field(mesh.layout.weight(weight));
  CellLevel level;
  level.weight = 0.25 * (w[cell.corner[0]] + w[cell.corner[1]] + w[cell.corner[2]] + w[cell.corner[3]]);
  if (cell.size > 1) {  // Simpson's rule both ways
    const double middles = 0.25 * (w[cell.side[0]] + w[cell.side[1]] + w[cell.side[2]] + w[cell.side[3]]);
    level.weight = (level.weight + 4.0 * middles + 4.0 * w[cell.middle]) / 9.0;
  }
  std::array<double, 4> e{};
  double mean = 0.0;
  double most = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    e[k] = mesh.irradiance(weight, cell.corner[k]);
    mean += 0.25 * e[k];
    most = std::max(most, std::abs(e[k]));
  }
  // Where the irradiance rises steeply, a plane through the corners would go below zero: it is then taken as constant.
  if (!(std::abs(mean) > 0.0) || most > 2.0 * std::abs(mean)) return level;
  level.along_d = (e[2] - e[0]) / mean;
  level.along_f = (e[3] - e[1]) / mean;
  return level;
}

void CellPainter::draw() {
  chosen_.join();
  for (std::size_t k = 0; k < chosen_.count(); ++k)
    for (const ChosenCell& cell : chosen_[k].cells) draw(chosen_[k], cell);
  chosen_.clear();
  cells_ = 0.0;
}

void CellPainter::draw(const BoxMesh& of, const ChosenCell& chosen) {
  const auto& [cell, state, sides, plane] = chosen;
  const Mesh& mesh = of.mesh;
  const std::array<Vec2, 4> p{mesh.position(cell.corner[0]), mesh.position(cell.corner[1]),
                              mesh.position(cell.corner[2]), mesh.position(cell.corner[3])};
  chosen_.outline(of, cell, all_corners_);
  const auto [area, centroid] = area_of(all_corners_.size(), [&](std::size_t k) { return all_corners_[k].position; });
  bool convex = true;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 a = p[k];
    convex =
        convex && cross(p[(k + 1) % 4] - a, p[(k + 2) % 4] - a) * area > 0.0 && mesh.area[cell.corner[k]] * area > 0.0;
  }
  const Vec2 d = p[2] - p[0];
  const Vec2 f = p[3] - p[1];
  const bool varied = cell.screen.part == ScreenPart::Varied;
  const double longest = std::max(length(d), length(f));
  const bool by_parts = varied && sees_by_parts(mesh, cell, longest);
  std::optional<Flux> mean;
  if (varied && (by_parts || is_dim(mesh, cell, kMeanBelow))) {
    const CellParts parts =
        parts_of(mesh, cell, by_parts ? parts_across(mesh, cell, longest) : CellParts::kFewestAcross);
    if (by_parts && state == State::Open && !is_dirty(mesh, cell) && are_uneven(mesh, cell, parts))
      return draw_parts(mesh, cell, parts);
    mean = parts.mean();
  }
  rise_ = {};
  if (!convex) return draw_folded(mesh, cell, state, mean);

  Shade shade;
  Flux flux{};
  const Vec2 middle = centroid + mesh.origin_px;
  shade.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
  const double flux_area = mesh.cell_flux_area_mm2 * cell.size * cell.size;
  // Pixels take the irradiance at their centres, which may lie well outside a cell smaller than a pixel.
  const double width = std::abs(area) / longest;
  const double sloped = std::clamp(width - 1.0, 0.0, 1.0);
  rise_ = weight_rise(mesh, cell);
  CellLevel level;
  for (std::size_t c = 0; c < 3; ++c) {
    if (static_cast<int>(c) < mesh.layout.weights) level = cell_level(mesh, cell, static_cast<int>(c));
    const double gain = mesh.gain[c], value = gain * level.weight * flux_area / std::abs(area);
    const double scale = sloped * value / cross(d, f);
    flux[c] = gain * level.weight * flux_area;
    shade.value[c] = static_cast<float>(value);
    shade.along_x[c] = static_cast<float>((level.along_d * f.y - level.along_f * d.y) * scale);
    shade.along_y[c] = static_cast<float>((level.along_f * d.x - level.along_d * f.x) * scale);
  }
  if (plane != nullptr) shade = *plane;
  const auto draw_seen = [&](const StopMap* map) {
    if (is_dirty(mesh, cell)) return draw_dirty(mesh, cell, state, shade, flux, map);
    draw_polygon(mesh, state, shade, flux, shape_of(mesh, cell, sides).all(), all_corners_,
                 {map, nullptr, cell.screen.most});
  };
  if (mean) dim(shade, flux, *mean);
  const auto map =
      varied && !mean ? std::optional(stop_map(mesh, cell, std::min(kSoft_px, kSoft * longest))) : std::nullopt;
  draw_seen(map ? &*map : nullptr);
}

// The rise of the first weight stands for all, since weights of the channels are alike.
Vec2 CellPainter::weight_rise(const Mesh& mesh, const Cell& cell) {
  const Mesh::Field& w = mesh.field(mesh.layout.weight(0));
  const std::array<double, 4> at{w[cell.corner[0]], w[cell.corner[1]], w[cell.corner[2]], w[cell.corner[3]]};
  const double sum = at[0] + at[1] + at[2] + at[3];
  if (!(sum > 0.0)) return {};
  return Vec2{at[1] + at[2] - at[0] - at[3], at[2] + at[3] - at[0] - at[1]} * (2.0 / sum);
}

// Draws each part as a polygon of its own, with its part of the cell's flux.
void CellPainter::draw_parts(const Mesh& mesh, const Cell& cell, const CellParts& parts) {
  std::array<Vec2, 4> corner;
  for (std::size_t k = 0; k < 4; ++k) corner[k] = mesh.position(cell.corner[k]) + mesh.origin_px;
  Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    const int weight = static_cast<int>(c) < mesh.layout.weights ? static_cast<int>(c) : 0;
    flux[c] = mesh.gain[c] * cell_level(mesh, cell, weight).weight * mesh.cell_flux_area_mm2 * cell.size * cell.size;
  }
  for (std::size_t k = 0; k < parts.count(); ++k) {
    Flux passed = flux;
    for (std::size_t c = 0; c < 3; ++c) passed[c] *= parts.room[k][c];
    if (passed == Flux{}) continue;
    std::array<Corner, 4> part;
    for (std::size_t j = 0; j < 4; ++j) {
      part[j].uv = parts.corner(k, j);
      part[j].position = CellParts::between(corner, part[j].uv);
    }
    const Vec2 middle = (part[0].position + part[2].position) * 0.5;
    draw_part(part, {.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)}}, passed, false, {});
  }
}

// Draws a folded cell as two triangles, each with its own flux at constant irradiance.
void CellPainter::draw_folded(const Mesh& mesh, const Cell& cell, State state, const std::optional<Flux>& mean) {
  const double flux_area = 0.5 * mesh.cell_flux_area_mm2 * cell.size * cell.size;
  for (const auto& t : {std::array{cell.corner[0], cell.corner[1], cell.corner[2]},
                        std::array{cell.corner[0], cell.corner[2], cell.corner[3]}}) {
    const std::array<CellCorner, 3> corners{CellCorner::at_vertex(mesh, t[0], {0, 0}),
                                            CellCorner::at_vertex(mesh, t[1], {1, 0}),
                                            CellCorner::at_vertex(mesh, t[2], {1, 1})};
    const std::array<Vec2, 3> p{mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
    const double area = 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0]));
    const Vec2 middle = (p[0] + p[1] + p[2]) * (1.0 / 3.0) + mesh.origin_px;
    Shade shade;
    Flux flux{};
    shade.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
    for (std::size_t c = 0; c < 3; ++c) {
      const Mesh::Field& w = mesh.field(mesh.layout.weight_of(static_cast<int>(c)));
      flux[c] = mesh.gain[c] * (w[t[0]] + w[t[1]] + w[t[2]]) / 3.0 * flux_area;
      shade.value[c] = static_cast<float>(flux[c] / std::max(area, 1e-12));
    }
    if (mean) dim(shade, flux, *mean);
    const auto map = cell.screen.part == ScreenPart::Varied && !mean ? std::optional(stop_map(mesh, t)) : std::nullopt;
    const auto dirt = is_dirty(mesh, cell) ? std::optional(dirt_triangle(mesh, t)) : std::nullopt;
    draw_polygon(mesh, state, shade, flux, corners, corners,
                 {map ? &*map : nullptr, dirt ? &*dirt : nullptr, cell.screen.most});
  }
}

std::span<const Corner> CellPainter::placed(const Mesh& mesh, State state, std::span<const CellCorner> corners,
                                            std::vector<Corner>& to) {
  to.resize(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    to[k].position = corners[k].position + mesh.origin_px;
    to[k].uv = corners[k].uv;
    for (int f = PatchLayout::kStop; state == State::Cut && f < mesh.layout.limits_end(); ++f)
      to[k].limit[static_cast<std::size_t>(f - PatchLayout::kStop)] = corners[k].value_of(mesh.field(f));
  }
  return to;
}

void CellPainter::draw_polygon(const Mesh& mesh, State state, const Shade& shade, const Flux& flux,
                               std::span<const CellCorner> shape, std::span<const CellCorner> outline,
                               const Behind& behind) {
  const bool triangle = shape.size() == 3;
  if (state != State::Cut) return draw_part(placed(mesh, state, outline, outline_), shade, flux, triangle, behind);
  const std::span<const Corner> whole = placed(mesh, state, shape, shape_);
  if (iris_.is_picture() && !screen_) return draw_pieces(mesh, whole, shade, flux, behind);
  const std::span<const Corner> along = outline.size() == shape.size() ? whole : placed(mesh, state, outline, outline_);
  const PatchLayout& layout = mesh.layout;
  const auto open = screen_
                        ? cutter_.within_rims(whole, along, layout.crossings, layout.rims)
                        : cutter_.open_part(whole, along, layout.crossings, layout.rims, arc_step(mesh, shape, shade));
  draw_part(open, shade, flux, triangle, behind);
}

// Draws what a picture as the iris leaves of a cell. Details that no pixel shows are drawn as their mean.
void CellPainter::draw_pieces(const Mesh& mesh, std::span<const Corner> cell, const Shade& shade, const Flux& flux,
                              const Behind& behind) {
  Bounds b;
  for (const Corner& c : cell) b.add(c.position);
  const double finest = std::min(1.0, kUnseenDetail / std::max({b.size().x, b.size().y, kUnseenDetail}));
  cutter_.for_each_open_part(cell, mesh.layout.crossings, mesh.layout.rims, finest,
                             [&](std::span<const Corner> part, double open) {
                               Shade dimmed = shade;
                               Flux less = flux;
                               dim(dimmed, less, {open, open, open});
                               draw_part(part, dimmed, less, cell.size() == 3, behind);
                             });
}

// The irradiance of a small polygon from its flux: the cell's flux times `share_per_px`. Near a focus irradiance varies
// within cells that pixels do not resolve, so that the fraction of flux that the iris transmits is not the fraction of
// area that it leaves.
Shade CellPainter::even_shade(const Shade& of, const Flux& flux, double share_per_px) {
  Shade even{.at = of.at};
  for (std::size_t c = 0; c < 3; ++c) even.value[c] = static_cast<float>(flux[c] * share_per_px);
  return even;
}

// The same for a polygon of a few pixels, which keeps the slope of its irradiance.
Shade CellPainter::with_flux(std::span<const Corner> polygon, const Shade& of, const Flux& flux, double share) const {
  constexpr double kMost = 2.0;
  const Vec2 aside = area_of(polygon.size(), [&](std::size_t k) { return polygon[k].uv; }).centroid - Vec2{0.5, 0.5};
  share *= std::max(1.0 + dot(rise_, aside), 0.0);
  const auto [area, middle] = area_of(polygon.size(), [&](std::size_t k) { return polygon[k].position; });
  const Vec2 from = middle - Vec2{of.at.x, of.at.y};
  Shade out = of;
  for (std::size_t c = 0; c < 3; ++c) {
    const double has = (of.value[c] + of.along_x[c] * from.x + of.along_y[c] * from.y) * std::abs(area);
    const double times = flux[c] * share / has;
    if (!(times > 1.0 / kMost && times < kMost)) continue;
    for (Channels Shade::* part : {&Shade::value, &Shade::along_x, &Shade::along_y})
      (out.*part)[c] *= static_cast<float>(times);
  }
  return out;
}

// triangle: `flux` is that of half the square of uv.
void CellPainter::draw_part(std::span<const Corner> polygon, const Shade& shade, const Flux& flux, bool triangle,
                            const Behind& behind) {
  if (polygon.size() < 3) return;
  Bounds b;
  double twice_area = 0.0;
  double twice_share = 0.0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Corner& c = polygon[k];
    b.add(c.position);
    if (k < 2) continue;
    twice_area += cross(polygon[k - 1].position - polygon[0].position, c.position - polygon[0].position);
    twice_share += cross(polygon[k - 1].uv - polygon[0].uv, c.uv - polygon[0].uv);
  }
  const double longest = std::max(b.size().x, b.size().y);
  const bool one_pixel = std::floor(b.low.x) == std::floor(b.high.x) && std::floor(b.low.y) == std::floor(b.high.y);
  const bool sliver = std::abs(twice_area) < kSliver * longest;
  const double area = 0.5 * std::abs(twice_area), share = 0.5 * std::abs(twice_share) * (triangle ? 2.0 : 1.0);
  if (!one_pixel && !sliver && longest > kSpeck) {
    if (longest < kSmall_px) return add_seen(polygon, area, even_shade(shade, flux, share / area), flux, behind);
    const bool few = longest < kFew_px && !triangle;  // half of a cell need not have half of its flux
    return add_seen(polygon, area, few ? with_flux(polygon, shade, flux, share) : shade, flux, behind);
  }
  Flux passed{flux[0] * share, flux[1] * share, flux[2] * share};
  const Vec2 middle = (b.low + b.high) * 0.5;
  if (behind.screen != nullptr) {
    std::array<StopPlace, kMaxStopCrossings> room;
    const auto screened = screen_->share(behind.screen->places(middle, room));
    for (std::size_t c = 0; c < 3; ++c) passed[c] *= screened[c];
  }
  if (behind.dirt != nullptr) {
    const auto left = past_dirt(*behind.dirt).passed(middle);
    for (std::size_t c = 0; c < 3; ++c) passed[c] *= left[c];
  }
  draw_line(polygon, passed);
}

// Draws a polygon thinner than rounding can resolve as points along its length that carry its flux.
void CellPainter::draw_line(std::span<const Corner> polygon, const Flux& flux) {
  std::array<Vec2, 2> ends{polygon[0].position, polygon[0].position};
  for (const Corner& a : polygon) {
    for (const Corner& b : polygon) {
      if (length(b.position - a.position) > length(ends[1] - ends[0])) ends = {a.position, b.position};
    }
  }
  const Vec2 along = ends[1] - ends[0];
  const int count = std::clamp(static_cast<int>(std::ceil(2.0 * length(along))), 1, kMostPoints);
  Shade point;
  for (std::size_t c = 0; c < 3; ++c) point.value[c] = static_cast<float>(flux[c] / count);
  for (int k = 0; k < count; ++k) {
    const Vec2 p = ends[0] + along * ((k + 0.5) / count);
    point.at = {static_cast<float>(p.x), static_cast<float>(p.y)};
    out_.add({&point.at, 1}, point);
  }
}

}  // namespace contrejour::inline internal::adaptive
