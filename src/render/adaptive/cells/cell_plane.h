// SPDX-License-Identifier: Apache-2.0
// One irradiance for many cells: a plane over their pixels. Cells are small where the iris clips them or the map
// curves, though the irradiance may vary slowly there; between cells on one plane no edge is drawn.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/adaptive/cells/mesh.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

// A square of a mesh's cells whose first vertex is at ix, iy.
struct MeshSquare {
  int ix = 0, iy = 0, size = 0;
};

struct IrradiancePlane {
  LinearIrradiance irradiance;
  double mean = 0.0;           // of the channels' RMS irradiance
  double squared_error = 0.0;  // of the channels' mean, summed over the cells' pixels
  double area_px = 0.0;
};

// Moments of the light over squares of one mesh.
class LightSums {
 public:
  // Integrates by Simpson's rule over 3 x 3 vertices. blocked: bits of Mesh::outside; a vertex at which one of them is
  // set is dark and gets a small weight.
  LightSums(const Mesh& mesh, const MeshSquare& square, std::uint32_t blocked);
  void add(const LightSums& other);

  // The least-squares plane through the irradiance at the vertices, weighted by pixels; it has the flux of the
  // vertices. Empty where the map folds, where the square is thinner than pixels, or where the plane would be negative
  // at a corner of the square.
  [[nodiscard]] std::optional<IrradiancePlane> plane(const Mesh& mesh, const MeshSquare& square) const;

 private:
  enum Moment : std::uint8_t { kOne, kX, kY, kXX, kXY, kYY, kMoments };
  int weights_ = 1;
  bool folds_ = false;
  std::array<double, kMoments> pixels_{};
  std::array<std::array<double, 4>, 3> light_{};  // by weight: light, times x, y, and its irradiance
};

}  // namespace contrejour::inline internal::adaptive
