// What of a box of a ghost's pupil lets light through, how much, and where that lands: exact rays on a grid, and finer
// grids where it does not tell.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "ghosts/light_frame.h"
#include "ghosts/ray_grid.h"

namespace contrejour::pupils {

// Two by two cells: their vertices row by row, and of these those of each cell in turn.
struct Block {
  std::array<std::uint32_t, 9> vertex;
  Vec2 low_mm;  // its corner, from the mesh's origin
};
inline constexpr std::array<std::array<std::size_t, 4>, 4> kCellsOfBlock{
    {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}};

// The rays of a grid over a box, or of finer ones over blocks of a coarser mesh.
struct LitMesh {
  Vec2 origin_mm, step_mm;  // of the entrance plane: the box's corner, a cell
  // One value a vertex. Of rays that fail, places mean nothing.
  std::vector<float> x_mm, y_mm;  // on the sensor, as the lens has it
  std::vector<float> transmission;
  std::vector<float> blocked;  // how far beyond what blocks: open at 0 and below, infinite where a ray fails
  // The sums of values times these are integrals over what is open, mm^2 of the entrance plane.
  std::vector<double> weight;
  std::vector<Block> blocks;  // but for those that a finer mesh is over

  [[nodiscard]] Vec2 landing_mm(std::size_t vertex) const { return {x_mm[vertex], y_mm[vertex]}; }
  [[nodiscard]] double cell_mm2() const { return step_mm.x * step_mm.y; }
};

// How rays are laid out: as many a side, an odd number; twice as many where fewer than enough are open; and finer where
// light is uncertain by more than a share of all.
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

  // All that gets through in disjoint boxes.
  [[nodiscard]] std::vector<LitMesh> trace(const std::vector<Rectangle>& boxes);

 private:
  void trace_grid(const Rectangle& box, int side);
  [[nodiscard]] std::optional<LitMesh> coarse_mesh(Rectangle box);
  [[nodiscard]] LitMesh finer_mesh(const LitMesh& coarse, const std::vector<Block>& blocks);

  PacketPath path_;
  const LightFrame& light_;
  const IrisShape& iris_;
  MeshDensity density_;
  RayGrid rays_;
  std::vector<float> x_mm_, y_mm_;
};

}  // namespace contrejour::pupils
