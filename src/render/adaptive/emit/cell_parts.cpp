// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/cell_parts.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/cells/stop_crossings.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kPart = 0.5;  // stop radii, and
constexpr double kPart_px = 0.4;  // pixels, across a part of a small cell

}  // namespace

Vec2 CellParts::uv_of(std::size_t part, Vec2 in_part) const {
  const Vec2 first{static_cast<double>(part % across), static_cast<double>(part / across)};
  return (first + in_part) * (1.0 / static_cast<double>(across));
}

Vec2 CellParts::corner(std::size_t part, std::size_t which) const {
  return uv_of(part, {which == 1 || which == 2 ? 1.0 : 0.0, which >= 2 ? 1.0 : 0.0});
}

Vec2 CellParts::between(const std::array<Vec2, 4>& corner, Vec2 uv) {
  return (corner[0] * (1.0 - uv.x) + corner[1] * uv.x) * (1.0 - uv.y) +
         (corner[3] * (1.0 - uv.x) + corner[2] * uv.x) * uv.y;
}

Flux CellParts::mean() const {
  Flux sum{};
  for (const Flux& one : transmitted())
    for (std::size_t c = 0; c < 3; ++c) sum[c] += one[c] / static_cast<double>(count());
  return sum;
}

bool CellParts::are_nonuniform(double max_difference) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto [smallest, largest] = std::ranges::minmax(transmitted(), {}, [&](const Flux& one) { return one[c]; });
    if (largest[c] - smallest[c] > max_difference) return true;
  }
  return false;
}

std::size_t parts_across(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px) {
  const double finest = std::max(longest_px / kPart_px, stop_size(band, mesh, cell) / kPart);
  return static_cast<std::size_t>(
      std::clamp(std::ceil(finest), 0.0 + CellParts::kMinAcross, 0.0 + CellParts::kMaxAcross));
}

CellParts parts_of(const BandContext& band, const Mesh& mesh, const Cell& cell, std::size_t across) {
  CellParts parts;
  parts.across = across;
  const auto crossings = static_cast<std::size_t>(mesh.layout.crossings);
  std::array<std::array<Vec2, 4>, kMaxStopCrossings> corner;
  std::array<StopPoint, kMaxStopCrossings> stop_points;
  for (std::size_t c = 0; c < crossings; ++c) {
    const StopPoints stop(mesh, static_cast<int>(c), band.stop_unit);
    for (std::size_t k = 0; k < 4; ++k) corner[c][k] = stop.at(cell.corner[k]);
    const double area = 0.5 * std::abs(cross(corner[c][2] - corner[c][0], corner[c][3] - corner[c][1]));
    stop_points[c].width = std::sqrt(area) / static_cast<double>(parts.across);
  }
  for (std::size_t k = 0; k < parts.count(); ++k) {
    for (std::size_t c = 0; c < crossings; ++c) stop_points[c].at = CellParts::between(corner[c], parts.middle(k));
    parts.values[k] = band.pattern->transmittance({stop_points.data(), crossings});
  }
  return parts;
}

}  // namespace contrejour::inline internal::adaptive
