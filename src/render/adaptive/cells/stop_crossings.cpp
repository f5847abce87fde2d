// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/stop_crossings.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kPatternDisc =
    1.2;  // radius of a curved cell over its vertices' distance from its middle, in the stop
constexpr double kPixelExtent = 0.75;  // pixels: slightly more than from a pixel's middle to its corners

// series_of: returns the series of a field from a function that gives its value at a vertex.
template <class SeriesOf>
StopMap map_of(const BandContext& band, const Mesh& mesh, double min_thickness_px, const SeriesOf& series_of) {
  std::array<CellSeries, kMaxStopCrossings> stop;
  for (int c = 0; c < mesh.layout.crossings; ++c)
    stop[static_cast<std::size_t>(c)] =
        series_of([stop_points = StopPoints(mesh, c, band.stop_unit)](std::size_t v) { return stop_points.at(v); });
  return {series_of([&](std::size_t v) { return mesh.position(v) + mesh.origin_px; }),
          {stop.data(), static_cast<std::size_t>(mesh.layout.crossings)},
          min_thickness_px};
}

}  // namespace

stop_patterns::PatternView view_of_pattern(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  const int last = mesh.layout.crossings - 1;
  if (!band.pattern || last < 0) return {PatternRegion::Uniform, 1.0};
  const StopPoints stop(mesh, last, band.stop_unit);
  const Vec2 middle = stop.at(cell.middle);
  double squared = 0.0;
  const auto include = [&](std::size_t v) {
    const Vec2 from = stop.at(v) - middle;
    squared = std::max(squared, dot(from, from));
  };
  for (const std::size_t v : cell.corner) include(v);
  for (const std::size_t v : cell.side) include(v);
  double squared_px = 0.0;
  for (const std::size_t v : cell.corner) {
    const Vec2 from = mesh.position(v) - mesh.position(cell.middle);
    squared_px = std::max(squared_px, dot(from, from));
  }
  // The disc includes what a neighbouring pixel's look-up reaches: where a cell of a pixel is drawn through the
  // pattern, its neighbours must be, too.
  const double radius = std::sqrt(squared), per_px = radius / std::max(std::sqrt(squared_px), kPixelExtent);
  stop_patterns::PatternView view = band.pattern->over(middle, kPatternDisc * radius + kPixelExtent * per_px);
  if (view.part == PatternRegion::Uniform && last > 0)
    view.part = PatternRegion::Varying;  // earlier crossings are sharp
  return view;
}

bool is_dim(const BandContext& band, const Mesh& mesh, const Cell& cell, double times) {
  return cell.pattern.max_transmittance * brightest(mesh, cell) < times * band.pattern->negligible_level;
}

double brightest(const Mesh& mesh, const Cell& cell) {
  float brightest = mesh.rms_irradiance[cell.middle];
  for (const std::size_t v : cell.corner) brightest = std::max(brightest, mesh.rms_irradiance[v]);
  for (const std::size_t v : cell.side) brightest = std::max(brightest, mesh.rms_irradiance[v]);
  return static_cast<double>(brightest);
}

double stop_size(const BandContext& band, const Mesh& mesh, const Cell& cell) {
  const StopPoints stop(mesh, mesh.layout.crossings - 1, band.stop_unit);
  const auto at = [&](std::size_t v) { return stop.at(v); };
  return std::max(length(at(cell.corner[2]) - at(cell.corner[0])), length(at(cell.corner[3]) - at(cell.corner[1])));
}

StopMap stop_map(const BandContext& band, const Mesh& mesh, const Cell& cell, double min_thickness_px) {
  return map_of(band, mesh, min_thickness_px, [&](const auto& at) {
    const std::array corner{at(cell.corner[0]), at(cell.corner[1]), at(cell.corner[2]), at(cell.corner[3])};
    if (cell.size == 1) return CellSeries::of_corners(corner);  // there are no vertices between the corners
    return CellSeries::of(corner, {at(cell.side[0]), at(cell.side[1]), at(cell.side[2]), at(cell.side[3])},
                          at(cell.middle));
  });
}

StopMap stop_map(const BandContext& band, const Mesh& mesh, const std::array<std::size_t, 3>& triangle) {
  return map_of(band, mesh, kMinThickness_px, [&](const auto& at) {
    return CellSeries::of_triangle({at(triangle[0]), at(triangle[1]), at(triangle[2])});
  });
}

}  // namespace contrejour::inline internal::adaptive
