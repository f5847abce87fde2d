// SPDX-License-Identifier: Apache-2.0
// A cell: a square of a mesh's vertices that may be drawn as one polygon.
// Thread-safety: values.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "render/adaptive/cells/mesh.h"
#include "render/polygons/polygon_list.h"
#include "render/stop_patterns/band_stop_pattern.h"

namespace contrejour::inline internal::adaptive {

// Open: nothing clips it. Cut: the iris or rims may clip it. Closed: no light passes.
enum class CellState : std::uint8_t { Open, Clipped, Blocked };
enum class Sides : std::uint8_t { Straight, Curved };  // curved sides have a corner in their middle

// The vertices of a square of mesh cells: its corners in order, the middles of its sides, its middle.
struct Cell {
  int ix = 0, iy = 0, size = 0;
  CellState state = CellState::Open;
  std::array<std::size_t, 4> corner{}, side{};
  std::size_t middle = 0;
  std::array<bool, 4> shared{};  // whether another cell of the same box lies beyond the side
  stop_patterns::PatternView pattern{PatternRegion::Uniform, 1.0};  // what the stop pattern transmits of its light

  // Its nine vertices, row by row. For a cell of size 1 corners stand for those between them.
  [[nodiscard]] std::array<std::size_t, 9> vertices() const {
    return {corner[0], side[0], corner[1], side[3], middle, side[1], corner[3], side[2], corner[2]};
  }
};

struct ChosenCell {
  Cell cell;
  Sides sides = Sides::Straight;
  const LinearIrradiance* plane = nullptr;  // irradiance that it shares with other cells; null: its own
};

// A picture as the iris clips triangles, within which corners on a cell's sides have no effect.
[[nodiscard]] inline Sides finest_sides(CellState state, const IrisShape& iris) {
  return state == CellState::Clipped && iris.is_picture() ? Sides::Straight : Sides::Curved;
}

}  // namespace contrejour::inline internal::adaptive
