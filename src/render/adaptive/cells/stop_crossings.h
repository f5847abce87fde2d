// SPDX-License-Identifier: Apache-2.0
// Finds the points at which a cell's light crosses the stop, and the stop pattern's transmittance there.
// Units: stop radii, pixels.
#pragma once

#include <array>
#include <cstddef>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"
#include "render/adaptive/cells/stop_map.h"

namespace contrejour::inline internal::adaptive {

inline constexpr double kMinThickness_px = 0.2;  // minimum thickness of cells in stop maps

// The points at which the rays of a mesh's vertices cross the stop.
class StopPoints {
 public:
  StopPoints(const Mesh& mesh, int crossing, double unit)
      : x_(mesh.field(PatchLayout::kStop + 2 * crossing).data()),
        y_(mesh.field(PatchLayout::kStop + 2 * crossing + 1).data()), unit_(unit) {}
  [[nodiscard]] Vec2 at(std::size_t vertex) const { return Vec2{x_[vertex], y_[vertex]} * unit_; }

 private:
  const float *x_, *y_;
  double unit_;
};

// The part of the stop pattern that a cell's last crossing of the stop covers.
[[nodiscard]] stop_patterns::PatternView view_of_pattern(const BandContext& band, const Mesh& mesh, const Cell& cell);

// The RMS of the channels' irradiance at the cell's brightest vertex.
[[nodiscard]] double brightest(const Mesh& mesh, const Cell& cell);

// Returns whether the light that passes the stop pattern is everywhere in the cell dimmer than `times` the negligible
// level.
[[nodiscard]] bool is_dim(const BandContext& band, const Mesh& mesh, const Cell& cell, double times);

// The longer of the cell's diagonals at its last crossing of the stop.
[[nodiscard]] double stop_size(const BandContext& band, const Mesh& mesh, const Cell& cell);

// The maps from the pixels of a cell, or of a triangle of vertices, to the stop. A cell thinner than
// `min_thickness_px`, or a triangle thinner than kMinThickness_px, is treated as if it were that thick.
[[nodiscard]] StopMap stop_map(const BandContext& band, const Mesh& mesh, const Cell& cell, double min_thickness_px);
[[nodiscard]] StopMap stop_map(const BandContext& band, const Mesh& mesh, const std::array<std::size_t, 3>& triangle);

}  // namespace contrejour::inline internal::adaptive
