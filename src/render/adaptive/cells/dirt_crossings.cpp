// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/dirt_crossings.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kDirtDisc = 1.2;  // radius of a curved cell over that of its vertices, in the dirt's plane

}  // namespace

std::array<double, 3> DirtTransmittance::transmitted(Vec2 pixel) const {
  std::array<StopPoint, kMaxStopCrossings> buffer;
  std::array<DirtPoint, kMaxStopCrossings> stop_points;
  std::size_t count = 0;
  for (const StopPoint& point : map.stop_points(pixel, buffer)) stop_points[count++] = {point.at, point.width};
  return band->transmission({stop_points.data(), count});
}

int dirt_crossings(const BandContext& band, const Mesh& mesh) {
  return band.dirt.site().on_front ? 1 : mesh.layout.crossings;
}

Vec2 dirt_point(const BandContext& band, const Mesh& mesh, std::size_t vertex, int crossing) {
  if (band.dirt.site().on_front) return band.dirt.front_point_of(mesh.entrance_mm(vertex));
  return StopPoints(mesh, crossing, band.stop_unit).at(vertex) * band.dirt.site().stop_radius_mm;
}

bool is_dirty(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  if (!band.dirt) return false;
  for (int c = 0; c < dirt_crossings(band, mesh); ++c) {
    const Vec2 middle = dirt_point(band, mesh, cell.middle, c);
    double radius = 0.0;
    for (const std::size_t v : cell.corner) radius = std::max(radius, length(dirt_point(band, mesh, v, c) - middle));
    if (!band.dirt.band->is_clean(middle, kDirtDisc * radius, static_cast<std::size_t>(c))) return true;
  }
  return false;
}

DirtTriangle dirt_triangle(const BandContext& band, const Mesh& mesh, const std::array<std::size_t, 3>& triangle) {
  DirtTriangle out;
  out.crossings = static_cast<std::size_t>(dirt_crossings(band, mesh));
  for (std::size_t k = 0; k < 3; ++k) {
    out.pixel[k] = mesh.position(triangle[k]) + mesh.origin_px;
    for (std::size_t c = 0; c < out.crossings; ++c)
      out.point_mm[c][k] = dirt_point(band, mesh, triangle[k], static_cast<int>(c));
  }
  return out;
}

DirtTransmittance dirt_transmittance(const BandContext& band, const DirtTriangle& dirt) {
  std::array<CellSeries, kMaxStopCrossings> stop_points;
  for (std::size_t c = 0; c < dirt.crossings; ++c) stop_points[c] = CellSeries::of_triangle(dirt.point_mm[c]);
  return {band.dirt.band.get(),
          {CellSeries::of_triangle(dirt.pixel), {stop_points.data(), dirt.crossings}, kMinThickness_px}};
}

double pixel_mm(const stop_patterns::PlaneView& view) { return std::sqrt(std::abs(cross(view.along_x, view.along_y))); }

}  // namespace contrejour::inline internal::adaptive
