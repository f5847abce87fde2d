// SPDX-License-Identifier: Apache-2.0
// The light of a cell: its flux, and the irradiance that its polygon is drawn with.
#pragma once

#include <algorithm>
#include <array>

#include "render/adaptive/cells/cell.h"
#include "render/adaptive/cells/mesh.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

using Flux = std::array<double, 3>;  // by channel, as pixel values

struct CellLight {
  LinearIrradiance irradiance{};
  Flux flux{};  // of the square 0 .. 1 of uv; triangle: of half of it
  Vec2 slope{};  // of what its rays carry: change from side to side along u and v, over the mean
  bool triangle = false;

  // Multiplies the light by a transmittance, or by minus the fraction that is taken away.
  void dim(const Flux& by);
};

[[nodiscard]] Flux flux_of(const Mesh& mesh, const Cell& cell);

// The drawn shape of a cell, in pixels relative to the mesh's origin.
struct DrawnShape {
  double signed_px = 0.0;
  Vec2 centroid;
  Vec2 diagonal, other_diagonal;  // from corner 0 to 2, and from 1 to 3
  [[nodiscard]] double longest_px() const { return std::max(length(diagonal), length(other_diagonal)); }
};

// Its irradiance has the cell's flux over the shape.
[[nodiscard]] CellLight light_of(const Mesh& mesh, const Cell& cell, const DrawnShape& shape);

// The light of half a cell as a triangle of its corners, at constant irradiance.
[[nodiscard]] CellLight light_of(const Mesh& mesh, const Cell& cell, const std::array<std::size_t, 3>& triangle);

}  // namespace contrejour::inline internal::adaptive
