// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/choose/common_plane.h"

#include <cmath>

#include "render/adaptive/budget/plane_budget.h"

namespace contrejour::inline internal::adaptive {

std::optional<LinearIrradiance> plane_for(const BandContext& band, const Mesh& mesh, const MeshSquare& square,
                                          double cell_budget) {
  const std::size_t middle = Mesh::at(square.ix + square.size / 2, square.iy + square.size / 2);
  if (std::abs(mesh.area[middle]) * square.size * square.size < kWorthPlane_px) return std::nullopt;
  const auto plane = LightSums(mesh, square, band.blocking(mesh)).plane(mesh, square);
  return plane && serves(*plane, band.peak, cell_budget) ? std::optional(plane->irradiance) : std::nullopt;
}

void find_planes(const BandContext& band, BoxMesh& of, double cell_budget) {
  const MeshSquare whole{0, 0, Mesh::kCells};
  LightSums light(of.mesh, quarter_square(0), band.blocking(of.mesh));
  for (std::size_t q = 1; q < 4; ++q) light.add({of.mesh, quarter_square(q), band.blocking(of.mesh)});
  const auto plane = light.plane(of.mesh, whole);
  if (plane && serves(*plane, band.peak, cell_budget)) return of.plane.fill(of.keep(plane->irradiance));
  for (std::size_t q = 0; q < 4; ++q) of.plane[q] = of.keep(plane_for(band, of.mesh, quarter_square(q), cell_budget));
}

}  // namespace contrejour::inline internal::adaptive
