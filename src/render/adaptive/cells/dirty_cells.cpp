// SPDX-License-Identifier: Apache-2.0
// Draws cells whose light passes dirt: as triangles, over which points in the dirt's plane are linear. Shapes subtract
// their light as polygons of negative sign. A picture of dirt, and shapes that overlap many times, are looked up pixel
// by pixel.
#include <algorithm>
#include <cmath>

#include "render/adaptive/cells/cell_painter.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kDirtDisc = 1.2;  // radius of a curved cell over that of its vertices, in the dirt's plane
constexpr double kMostEdges = 8.0;  // total length of edges over the cell's length, at most: more are not visible

using Places = std::array<Vec2, 3>;

// The side, in mm, of a square with a pixel's area in the dirt's plane.
double pixel_mm(const screens::PlaneView& view) { return std::sqrt(std::abs(cross(view.along_x, view.along_y))); }

Vec2 pixels_between(const screens::PlaneView& view, Vec2 off_mm) {
  const double determinant = cross(view.along_x, view.along_y);
  return Vec2{cross(off_mm, view.along_y), cross(view.along_x, off_mm)} * (1.0 / determinant);
}

}  // namespace

std::array<double, 3> PastDirt::passed(Vec2 pixel) const {
  std::array<StopPlace, kMaxStopCrossings> room;
  std::array<DirtPlace, kMaxStopCrossings> places;
  std::size_t count = 0;
  for (const StopPlace& place : map.places(pixel, room)) places[count++] = {place.at, place.width};
  return band->transmission({places.data(), count});
}

int CellPainter::dirt_crossings(const Mesh& mesh) const { return dirt_.plane().on_front() ? 1 : mesh.layout.crossings; }

Vec2 CellPainter::dirt_place(const Mesh& mesh, std::size_t vertex, int crossing) const {
  if (dirt_.plane().on_front()) return dirt_.front_place(mesh.entrance_mm(vertex));
  return stop_place(mesh, vertex, crossing) * dirt_.plane().stop_radius_mm();
}

bool CellPainter::is_dirty(const Mesh& mesh, const Cell& cell) const {
  if (!dirt_) return false;
  for (int c = 0; c < dirt_crossings(mesh); ++c) {
    const Vec2 middle = dirt_place(mesh, cell.middle, c);
    double radius = 0.0;
    for (const std::size_t v : cell.corner) radius = std::max(radius, length(dirt_place(mesh, v, c) - middle));
    if (!dirt_.band->is_clean(middle, kDirtDisc * radius, static_cast<std::size_t>(c))) return true;
  }
  return false;
}

// The squared displacement of shadows in the cell's two triangles, summed over the pixels along their edges.
double CellPainter::shadow_error(const Mesh& mesh, const Cell& cell) const {
  double most = 0.0;
  const DirtScreen::Edges soft = dirt_.band->edges();
  for (int c = 0; c < dirt_crossings(mesh); ++c) {
    double off = 0.0, area_mm2 = 0.0, longest_px = 0.0, width_px = 1.0;
    for (const std::size_t third : {std::size_t{1}, std::size_t{3}}) {
      const std::array<std::size_t, 3> corner{cell.corner[0], cell.corner[third], cell.corner[2]};
      // Sides 0 and 1 meet in corner 1, sides 2 and 3 in corner 3.
      const std::array<std::size_t, 3> between{cell.side[third - 1], cell.side[third], cell.middle};
      Places position, place;
      for (std::size_t k = 0; k < 3; ++k) {
        position[k] = mesh.position(corner[k]);
        place[k] = dirt_place(mesh, corner[k], c);
      }
      const auto view = screens::PlaneView::through(position, place);
      if (!(std::abs(cross(view.along_x, view.along_y)) > 0.0)) continue;
      for (const std::size_t v : between)
        off = std::max(off, length(pixels_between(view, dirt_place(mesh, v, c) - view.place(mesh.position(v)))));
      width_px = std::max(width_px, soft.softness_mm / pixel_mm(view));
      area_mm2 += 0.5 * std::abs(cross(place[1] - place[0], place[2] - place[0]));
      longest_px = std::max(longest_px, length(position[2] - position[0]));
    }
    const double side_mm = std::sqrt(area_mm2);
    const double edges = side_mm > 0.0 ? area_mm2 * soft.per_mm / side_mm : 0.0;
    most = std::max(most, std::min(off * off / width_px, off) * std::min(edges, kMostEdges) * longest_px);
  }
  return most;
}

CellPainter::DirtTriangle CellPainter::dirt_triangle(const Mesh& mesh,
                                                     const std::array<std::size_t, 3>& triangle) const {
  DirtTriangle out;
  out.crossings = static_cast<std::size_t>(dirt_crossings(mesh));
  for (std::size_t k = 0; k < 3; ++k) {
    out.pixel[k] = mesh.position(triangle[k]) + mesh.origin_px;
    for (std::size_t c = 0; c < out.crossings; ++c)
      out.place_mm[c][k] = dirt_place(mesh, triangle[k], static_cast<int>(c));
  }
  return out;
}

PastDirt CellPainter::past_dirt(const DirtTriangle& dirt) const {
  std::array<CellSeries, kMaxStopCrossings> places;
  for (std::size_t c = 0; c < dirt.crossings; ++c) places[c] = CellSeries::of_triangle(dirt.place_mm[c]);
  return {dirt_.band.get(), {CellSeries::of_triangle(dirt.pixel), {places.data(), dirt.crossings}, kSoft_px}};
}

// Draws the cell as two triangles, over each of which points in the dirt's plane are linear.
void CellPainter::draw_dirty(const Mesh& mesh, const Cell& cell, State state, const Shade& shade, const Flux& flux,
                             const StopMap* map) {
  const Flux half{0.5 * flux[0], 0.5 * flux[1], 0.5 * flux[2]};
  for (const auto& t : {std::array{cell.corner[0], cell.corner[1], cell.corner[2]},
                        std::array{cell.corner[0], cell.corner[2], cell.corner[3]}}) {
    const std::array<CellCorner, 3> corners{CellCorner::at_vertex(mesh, t[0], {0, 0}),
                                            CellCorner::at_vertex(mesh, t[1], {1, 0}),
                                            CellCorner::at_vertex(mesh, t[2], {1, 1})};
    const DirtTriangle dirt = dirt_triangle(mesh, t);
    draw_polygon(mesh, state, shade, half, corners, corners, {map, &dirt});
  }
}

void CellPainter::add_seen(std::span<const Corner> polygon, double area_px, const Shade& shade, const Flux& flux,
                           const Behind& behind) {
  if (behind.dirt != nullptr && dirt_.band->outlines() != nullptr) {
    add_seen(polygon, area_px, shade, flux, {behind.screen, nullptr, behind.most});
    return add_shadows(polygon, shade, flux, behind);
  }
  if (behind.dirt != nullptr) {
    out_.dirt.push_back(past_dirt(*behind.dirt));
    Screened seen{behind.screen != nullptr ? *behind.screen : out_.dirt.back().map,
                  behind.screen != nullptr ? screen_.get() : nullptr};
    seen.dirt = static_cast<std::uint32_t>(out_.dirt.size());
    return out_.add(points_of(polygon), shade, seen, {});
  }
  if (behind.screen != nullptr)
    return draw_screened(polygon, area_px, shade, *behind.screen,
                         looks_across_pixel(shade, behind.most, *behind.screen));
  out_.add(points_of(polygon), shade);
}

void CellPainter::add_shadows(std::span<const Corner> polygon, const Shade& shade, const Flux& flux,
                              const Behind& behind) {
  const DirtTriangle& dirt = *behind.dirt;
  std::array<screens::PlaneView, kMaxStopCrossings> views;
  double finest_mm = 0.0;
  for (std::size_t c = 0; c < dirt.crossings; ++c) {
    views[c] = screens::PlaneView::through(dirt.pixel, dirt.place_mm[c]);
    finest_mm = c == 0 ? pixel_mm(views[c]) : std::min(finest_mm, pixel_mm(views[c]));
  }
  // The coordinates of the three corners in their cell, in the order in which they are drawn.
  const auto in_cell = screens::PlaneView::through(dirt.pixel, Places{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{1.0, 1.0}});
  std::vector<Vec2> outline;
  for (const Corner& c : polygon) outline.push_back(c.position);
  std::vector<Corner> part;
  shadows_.for_each(*dirt_.band->outlines(), {views.data(), dirt.crossings}, outline, finest_mm,
                    [&](std::span<const Vec2> shadow, double blocked) {
                      Shade taken = shade;
                      Flux lost = flux;
                      dim(taken, lost, {-blocked, -blocked, -blocked});
                      part.assign(shadow.size(), Corner{});
                      double twice_area = 0.0;
                      for (std::size_t k = 0; k < shadow.size(); ++k) {
                        part[k].position = shadow[k];
                        part[k].uv = in_cell.place(shadow[k]);
                        if (k > 1) twice_area += cross(shadow[k - 1] - shadow[0], shadow[k] - shadow[0]);
                      }
                      add_seen(part, 0.5 * std::abs(twice_area), taken, lost, {behind.screen, nullptr, behind.most});
                    });
}

}  // namespace contrejour::inline internal::adaptive
