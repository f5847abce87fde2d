// SPDX-License-Identifier: Apache-2.0
// A patch at the vertices of a uniform mesh of 8 x 8 cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ghosts/iris_shape.h"
#include "render/adaptive/cells/ray_map_names.h"

namespace contrejour::inline internal::adaptive {

struct Mesh {
  static constexpr int kCells = 8;
  static constexpr int kSide = kCells + 1;
  static constexpr int kStride = 16;
  static constexpr std::size_t kVertices = static_cast<std::size_t>(kSide) * kStride;
  using Field = std::array<float, kVertices>;

  PatchLayout layout;
  Vec2 origin_px;
  Rectangle box;                          // as the patch's
  std::vector<Field> fields;              // fields of the patch at the vertices
  Field area;                             // signed image area of a cell, by the derivatives at the vertex, in pixels
  Field rms_irradiance;                       // root mean square of the channels' irradiance, per pixel
  double cell_flux_area_mm2 = 0;          // of one cell: its area in the entrance plane times cos(theta)
  Rgb gain;                               // as the patch's
  std::array<std::uint32_t, kVertices> outside;  // bits set where the vertex is outside a crossing, then a rim
  static constexpr std::uint32_t kNearObscuration = 1U << 31;  // also: an obscuration may begin before the next vertex

  [[nodiscard]] static std::size_t at(int ix, int iy) {
    return static_cast<std::size_t>(iy) * kStride + static_cast<std::size_t>(ix);
  }
  [[nodiscard]] const Field& field(int f) const { return fields[static_cast<std::size_t>(f)]; }
  [[nodiscard]] Vec2 position(std::size_t vertex) const {
    return {field(PatchLayout::kX)[vertex], field(PatchLayout::kY)[vertex]};
  }
  [[nodiscard]] Vec2 entrance_mm(std::size_t vertex) const {
    const Vec2 size = box.high - box.low;
    return box.low +
           Vec2{size.x * static_cast<double>(vertex % kStride), size.y * static_cast<double>(vertex / kStride)} *
               (1.0 / kCells);
  }
  // The irradiance by one of the weights, without gain, as flux per pixel; large where the map folds.
  [[nodiscard]] double irradiance(int weight, std::size_t vertex) const;
};

// Evaluates a patch into `mesh`, whose old contents do not matter and whose memory is used again.
void make_mesh(const Patch& patch, const IrisShape& iris, Mesh& mesh);

}  // namespace contrejour::inline internal::adaptive
