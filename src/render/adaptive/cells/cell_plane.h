// One irradiance for many cells: a plane over their pixels. Cells are small where the iris cuts them or the map bends,
// and light may be even there; between cells of one plane there is nothing to draw.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/adaptive/cells/mesh.h"
#include "render/adaptive/tiles/polygon_list.h"

namespace contrejour::adaptive {

// A square of a mesh's cells, from ix, iy on.
struct MeshSquare {
  int ix = 0, iy = 0, size = 0;
};

struct IrradiancePlane {
  Shade shade;
  double mean = 0.0;           // brightness
  double squared_error = 0.0;  // of the channels' mean, over the cells' pixels
  double area_px = 0.0;
};

// Sums over the light of squares of one mesh.
class LightSums {
 public:
  // By Simpson's rule over 3 x 3 vertices. blocked: bits of Mesh::outside; what they are set for counts little, being
  // dark.
  LightSums(const Mesh& mesh, const MeshSquare& square, std::uint32_t blocked);
  void add(const LightSums& other);

  // Through the irradiance at the vertices by least squares over the pixels: as much light as they have. None where the
  // map folds, where the square is thinner than pixels, or where it would be negative at its corners.
  [[nodiscard]] std::optional<IrradiancePlane> plane(const Mesh& mesh, const MeshSquare& square) const;

 private:
  enum Moment : std::uint8_t { kOne, kX, kY, kXX, kXY, kYY, kMoments };
  int weights_ = 1;
  bool folds_ = false;
  std::array<double, kMoments> pixels_{};
  std::array<std::array<double, 4>, 3> light_{};  // by weight: light, times x, y, and its irradiance
};

}  // namespace contrejour::adaptive
