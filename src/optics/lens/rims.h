// SPDX-License-Identifier: Apache-2.0
// Where surfaces end and where neighbours cross: validate() refuses such lenses, and readers of other programs' files
// reduce the semi-diameters.
#pragma once

#include <functional>
#include <span>

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Vertices and rims may touch: patents give thicknesses to 1 um at best, and rounding must not invalidate a lens.
inline constexpr double kTouch_mm = 1e-3;

struct Gap {
  double gap_mm = 0, height_mm = 0;
};

// The smallest gap between two surfaces, with vertices thickness_mm apart, within height_mm of the axis.
[[nodiscard]] Gap smallest_gap(const Surface& front, const Surface& back, double thickness_mm, double height_mm);

// True if the surface exists at all heights up to this one. A sphere ends at its radius, a conic where its square root
// does.
[[nodiscard]] bool reaches(const Surface& surface, double height_mm);

// Calls body(front, back, thickness_mm) for neighbouring refracting surfaces, as long as it returns true. The stop is
// ignored: design programs put its plane at the vertex of a surface, which a concave surface then crosses.
void for_each_neighbours(std::span<const Surface> surfaces, std::span<const double> thickness_mm,
                         const std::function<bool(std::size_t front, std::size_t back, double thickness_mm)>& body);

// The thicknesses of each zoom position, or of the prime lens.
[[nodiscard]] std::vector<std::vector<double>> thicknesses_of(const Prescription& lens);

}  // namespace contrejour::inline internal
