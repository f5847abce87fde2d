// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/arc_step.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kChordFraction = 0.5;  // fraction of a cell's error that chords in place of an arc may make
constexpr double kMinChordDistance_px = 0.02;  // smaller distances are not asked for
constexpr double kShortestArcStep = 0.02, kLongestArcStep = 0.8;  // radians

}  // namespace

double arc_step(const BandContext& band, const Mesh& mesh, std::span<const CellCorner> corners,
                const LinearIrradiance& irradiance, double cell_budget) {
  double extent = 0.0;
  Bounds b;
  for (const CellCorner& corner : corners) {
    b.add(mesh.position(corner.vertex));
    for (int f = PatchLayout::kStop; f < mesh.layout.rim(0); ++f) {
      const Mesh::Field& stop = mesh.field(f);
      extent = std::max(extent, std::abs(static_cast<double>(stop[corner.vertex]) - stop[corners[0].vertex]));
    }
  }
  const double longest = std::max(b.size().x, b.size().y);
  const double level =
      std::max({std::abs(irradiance.value[0]), std::abs(irradiance.value[1]), std::abs(irradiance.value[2])});
  const double visible = level * peak_limited_weight(level, band.peak);
  const double max_px = level > kFacetLevel * band.peak ? kMaxVisibleChordDistance_px : kMaxChordDistance_px;
  const double displacement_px =
      std::clamp(kChordFraction * std::sqrt(cell_budget / std::max(longest, 1.0)) / std::max(visible, 1e-300),
                 kMinChordDistance_px, max_px);
  const double pixels_per_radius = longest / std::max(extent, 1e-9);
  return std::clamp(std::sqrt(8.0 * displacement_px / pixels_per_radius), kShortestArcStep, kLongestArcStep);
}

}  // namespace contrejour::inline internal::adaptive
