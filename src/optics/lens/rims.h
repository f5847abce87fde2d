// Where surfaces end and where neighbours meet: what validate() refuses and what readers of other programs' files make
// smaller.
#pragma once

#include <functional>
#include <span>

#include "contrejour/lens.h"

namespace contrejour {

// Vertices and rims may touch: patents give thicknesses to 1 um at best, and their rounding must not refuse a lens.
inline constexpr double kTouch_mm = 1e-3;

struct Gap {
  double gap_mm = 0, height_mm = 0;
};

// Where two surfaces, their vertices thickness_mm apart, come nearest to each other within height_mm of the axis.
[[nodiscard]] Gap smallest_gap(const Surface& front, const Surface& back, double thickness_mm, double height_mm);

// Is there a surface at all heights up to this one? A sphere ends at its radius, a conic where its root does.
[[nodiscard]] bool reaches(const Surface& surface, double height_mm);

// Calls body(front, back, thickness_mm) for neighbouring refracting surfaces, as long as it returns true. The stop is
// no matter: design programs put its plane at the vertex of a surface, where a concave one reaches through it.
void for_each_neighbours(std::span<const Surface> surfaces, std::span<const double> thickness_mm,
                         const std::function<bool(std::size_t front, std::size_t back, double thickness_mm)>& body);

// The thicknesses of each zoom position in turn, or the only ones.
[[nodiscard]] std::vector<std::vector<double>> thicknesses_of(const Prescription& lens);

}  // namespace contrejour
