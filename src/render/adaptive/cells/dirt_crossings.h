// SPDX-License-Identifier: Apache-2.0
// Finds the points at which a cell's light crosses the plane of the dirt. Over a triangle of vertices these points are
// linear. Units: mm, pixels.
#pragma once

#include <array>
#include <cstddef>

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/cell.h"
#include "render/adaptive/cells/stop_map.h"
#include "render/stop_patterns/shadow_clipper.h"

namespace contrejour::inline internal::adaptive {

// Dirt that is looked up for each pixel, and the map from pixels to its plane, in mm.
struct DirtTransmittance {
  const stop_patterns::BandDirt* band;
  StopMap map;
  [[nodiscard]] std::array<double, 3> transmitted(Vec2 pixel) const;
};

struct DirtTriangle {
  std::array<Vec2, 3> pixel;
  std::array<std::array<Vec2, 3>, kMaxStopCrossings> point_mm;
  std::size_t crossings = 0;
};

// Returns how often the light crosses the dirt's plane. This and the following functions: the band's light passes dirt.
[[nodiscard]] int dirt_crossings(const BandContext& band, const Mesh& mesh);
[[nodiscard]] Vec2 dirt_point(const BandContext& band, const Mesh& mesh, std::size_t vertex, int crossing);
[[nodiscard]] DirtTriangle dirt_triangle(const BandContext& band, const Mesh& mesh,
                                         const std::array<std::size_t, 3>& triangle);
// For dirt that is looked up pixel by pixel.
[[nodiscard]] DirtTransmittance dirt_transmittance(const BandContext& band, const DirtTriangle& dirt);

// Returns whether the cell's light may pass a shape of the dirt; false where the lens is clean.
[[nodiscard]] bool is_dirty(const BandContext& band, const Mesh& mesh, const Cell& cell);

// The side, in mm, of a square with a pixel's area in the dirt's plane.
[[nodiscard]] double pixel_mm(const stop_patterns::PlaneView& view);

}  // namespace contrejour::inline internal::adaptive
