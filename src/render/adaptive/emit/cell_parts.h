// SPDX-License-Identifier: Apache-2.0
// A small cell behind a stop pattern, in parts of equal size: pixels are too far apart to look the pattern up.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"
#include "render/adaptive/emit/cell_light.h"

namespace contrejour::inline internal::adaptive {

// The transmittance of the stop pattern for each part of a cell.
struct CellParts {
  static constexpr std::size_t kMinAcross = 3, kMaxAcross = 10;
  std::size_t across;
  std::array<Flux, kMaxAcross * kMaxAcross> values;  // the first count() are in use

  [[nodiscard]] std::size_t count() const { return across * across; }
  [[nodiscard]] std::span<const Flux> transmitted() const { return {values.data(), count()}; }
  // In coordinates of the cell, each from 0 to 1.
  [[nodiscard]] Vec2 middle(std::size_t part) const { return uv_of(part, {0.5, 0.5}); }
  [[nodiscard]] Vec2 corner(std::size_t part, std::size_t which) const;
  // Interpolates bilinearly between values at the cell's corners.
  [[nodiscard]] static Vec2 between(const std::array<Vec2, 4>& corner, Vec2 uv);
  [[nodiscard]] Flux mean() const;
  // Returns whether the parts differ by more than `largest` in any channel.
  [[nodiscard]] bool are_nonuniform(double largest) const;

 private:
  [[nodiscard]] Vec2 uv_of(std::size_t part, Vec2 in_part) const;
};

// The number of parts across a cell that resolve pixels and the pattern.
[[nodiscard]] std::size_t parts_across(const BandContext& band, const Mesh& mesh, const Cell& cell, double longest_px);

[[nodiscard]] CellParts parts_of(const BandContext& band, const Mesh& mesh, const Cell& cell, std::size_t across);

}  // namespace contrejour::inline internal::adaptive
