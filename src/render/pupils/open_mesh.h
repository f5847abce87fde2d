// SPDX-License-Identifier: Apache-2.0
// The open part of a box of a ghost's pupil, its transmittance and its points on the sensor: exact rays on a grid, with
// finer grids where the integral is uncertain.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ghosts/light_frame.h"
#include "ghosts/ray_grid.h"

namespace contrejour::inline internal::pupils {

// Two by two cells: their vertices row by row, and the vertices of each cell in order.
struct Block {
  std::array<std::uint32_t, 9> vertex;
  Vec2 low_mm;  // its corner, from the mesh's origin
};
inline constexpr std::array<std::array<std::size_t, 4>, 4> kCellsOfBlock{
    {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}};

// The rays of a grid over a box, or of finer ones over blocks of a coarser mesh.
struct OpenMesh {
  Vec2 origin_mm, step_mm;  // of the entrance plane: the box's corner, a cell
  // One value a vertex. Points of rays that fail are undefined.
  std::vector<float> x_mm, y_mm;  // on the sensor, in the lens's frame
  std::vector<float> transmission;
  std::vector<float> blocked;  // amount by which a ray is outside the bounds: open at 0 and below, infinite where a ray
                               // fails
  // The sums of values times these weights are integrals over the open part, mm^2 of the entrance plane.
  std::vector<double> weight;
  std::vector<Block> blocks;  // without those that a finer mesh covers

  [[nodiscard]] Vec2 sensor_point_mm(std::size_t vertex) const { return {x_mm[vertex], y_mm[vertex]}; }
  [[nodiscard]] double cell_mm2() const { return step_mm.x * step_mm.y; }
};

// The density of rays: an odd number a side; twice as many if fewer than enough_open are open; and finer where the
// error of the light exceeds a fraction of the total.
struct MeshDensity {
  int side = 33;
  std::ptrdiff_t enough_open = 120;
  double uncertain = 1e-4;
};

// Traces meshes of one ghost and light at one wavelength. Everything that it refers to must outlive it.
class MeshTracer {
 public:
  // path: of the light in its frame, from any point of the entrance plane.
  MeshTracer(PacketPath path, const LightFrame& light, const IrisShape& iris, MeshDensity density)
      : path_(std::move(path)), light_(light), iris_(iris), density_(density) {}

  // Traces the meshes of disjoint boxes.
  [[nodiscard]] std::vector<OpenMesh> trace(const std::vector<Rectangle>& boxes);

 private:
  void trace_grid(const Rectangle& box, int side);
  [[nodiscard]] std::optional<OpenMesh> coarse_mesh(Rectangle box);
  [[nodiscard]] OpenMesh finer_mesh(const OpenMesh& coarse, const std::vector<Block>& blocks);

  PacketPath path_;
  const LightFrame& light_;
  const IrisShape& iris_;
  MeshDensity density_;
  RayGrid rays_;
  std::vector<float> x_mm_, y_mm_;
};

}  // namespace contrejour::inline internal::pupils
