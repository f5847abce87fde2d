// One irradiance for many cells: a plane over their pixels. Cells are small where the iris cuts them or the map bends,
// and light may be even there; between cells of one plane there is nothing to draw.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/adaptive/mesh.h"
#include "render/adaptive/polygon_list.h"

namespace contrejour::adaptive {

struct IrradiancePlane {
  Shade shade;
  double mean = 0.0;           // brightness
  double squared_error = 0.0;  // of the channels' mean, over the cells' pixels
  double area_px = 0.0;
};

// Sums over a mesh's light, block by block of 2 x 2 cells.
class MeshLight {
 public:
  // blocked: bits of Mesh::outside; what they are set for counts little, being dark.
  MeshLight(const Mesh& mesh, std::uint32_t blocked);

  // Through the irradiance at the vertices of size x size cells from ix, iy on, all of them even, by least squares over
  // the pixels: as much light as they have. None where the map folds, where they are thinner than pixels, or where it
  // would be negative.
  [[nodiscard]] std::optional<IrradiancePlane> plane(int ix, int iy, int size) const;

 private:
  static constexpr int kBlock = 2, kBlocks = Mesh::kCells / kBlock;
  enum Moment : std::uint8_t { kOne, kX, kY, kXX, kXY, kYY, kMoments };
  struct Sums {
    std::array<double, kMoments> pixels{};
    std::array<std::array<double, 4>, 3> light{};  // by weight: light, times x, y, and its irradiance
    void add(const Sums& other, int weights, double times);
  };
  [[nodiscard]] Sums vertex_sums(std::size_t vertex, double share) const;

  const Mesh& mesh_;
  Vec2 origin_;
  std::array<Sums, static_cast<std::size_t>(kBlocks) * kBlocks> blocks_;
  std::array<bool, static_cast<std::size_t>(kBlocks) * kBlocks> folds_{};
};

}  // namespace contrejour::adaptive
