// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/plane_errors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/adaptive/budget/small_polygons.h"
#include "render/adaptive/cells/dirt_crossings.h"
#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kExact = 1e-3;  // softness of the map from which a cell's error is measured, over the cell's size
constexpr double kOnePoint_px = 1.0;  // cells no longer than this are points to pixels
constexpr double kCoarse = 0.5;       // stop radii a pixel: four pixels or fewer cover the stop
constexpr double kMaxEdges = 8.0;  // total length of dirt's edges over the cell's length, at most: more are not visible

Vec2 pixels_between(const stop_patterns::PlaneView& view, Vec2 off_mm) {
  const double determinant = cross(view.along_x, view.along_y);
  return Vec2{cross(off_mm, view.along_y), cross(view.along_x, off_mm)} * (1.0 / determinant);
}

}  // namespace

bool sees_by_parts(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px) {
  return longest_px < kOnePoint_px || (longest_px < kSmall_px && stop_size(band, mesh, cell) > kCoarse * longest_px);
}

double map_error(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px) {
  const double size = stop_size(band, mesh, cell);
  if (!(size > 0.0)) return 0.0;
  const StopMap map = stop_map(band, mesh, cell, kExact * longest_px);
  double squared = 0.0;
  for (int c = 0; c < mesh.layout.crossings; ++c) {
    const StopPoints stop(mesh, c, band.stop_unit);
    const auto check = [&](std::size_t v) {
      const Vec2 off = map.stop_point(mesh.position(v) + mesh.origin_px, static_cast<std::size_t>(c)) - stop.at(v);
      squared = std::max(squared, dot(off, off));
    };
    for (const std::size_t v : cell.corner) check(v);
    for (const std::size_t v : cell.side) check(v);
  }
  return std::sqrt(squared) / size;
}

double shadow_error(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  double largest = 0.0;
  const DirtEdges soft = band.dirt.band->edges();
  for (int c = 0; c < dirt_crossings(band, mesh); ++c) {
    double off = 0.0, area_mm2 = 0.0, longest_px = 0.0, width_px = 1.0;
    for (const std::size_t third : {std::size_t{1}, std::size_t{3}}) {
      const std::array<std::size_t, 3> corner{cell.corner[0], cell.corner[third], cell.corner[2]};
      // Sides 0 and 1 meet in corner 1, sides 2 and 3 in corner 3.
      const std::array<std::size_t, 3> between{cell.side[third - 1], cell.side[third], cell.middle};
      std::array<Vec2, 3> position, dirt_mm;
      for (std::size_t k = 0; k < 3; ++k) {
        position[k] = mesh.position(corner[k]);
        dirt_mm[k] = dirt_point(band, mesh, corner[k], c);
      }
      const auto view = stop_patterns::PlaneView::through(position, dirt_mm);
      if (!(std::abs(cross(view.along_x, view.along_y)) > 0.0)) continue;
      for (const std::size_t v : between)
        off = std::max(off, length(pixels_between(view, dirt_point(band, mesh, v, c) - view.at(mesh.position(v)))));
      width_px = std::max(width_px, soft.edge_width_mm / pixel_mm(view));
      area_mm2 += 0.5 * std::abs(cross(dirt_mm[1] - dirt_mm[0], dirt_mm[2] - dirt_mm[0]));
      longest_px = std::max(longest_px, length(position[2] - position[0]));
    }
    const double side_mm = std::sqrt(area_mm2);
    const double edges = side_mm > 0.0 ? area_mm2 * soft.per_mm / side_mm : 0.0;
    largest = std::max(largest, std::min(off * off / width_px, off) * std::min(edges, kMaxEdges) * longest_px);
  }
  return largest;
}

}  // namespace contrejour::inline internal::adaptive
