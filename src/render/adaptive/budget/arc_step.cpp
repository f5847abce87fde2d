// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/arc_step.h"

#include <algorithm>
#include <cmath>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kChordShare = 0.5;  // fraction of a cell's error that chords in place of an arc may make
constexpr double kLeastOfChord_px = 0.02;  // smaller distances are not asked for
constexpr double kShortestArcStep = 0.02, kLongestArcStep = 0.8;  // radians

}  // namespace

double arc_step(const BandContext& band, const Mesh& mesh, std::span<const CellCorner> corners, const Shade& shade,
                double cell_budget) {
  double reach = 0.0;
  Bounds b;
  for (const CellCorner& corner : corners) {
    b.add(mesh.position(corner.vertex));
    for (int f = PatchLayout::kStop; f < mesh.layout.rim(0); ++f) {
      const Mesh::Field& stop = mesh.field(f);
      reach = std::max(reach, std::abs(static_cast<double>(stop[corner.vertex]) - stop[corners[0].vertex]));
    }
  }
  const double longest = std::max(b.size().x, b.size().y);
  const double level = std::max({std::abs(shade.value[0]), std::abs(shade.value[1]), std::abs(shade.value[2])});
  const double seen = level * seen_share(level, band.peak);
  const double most_px = level > kFacetLevel * band.peak ? kMostOfSeenChord_px : kMostOfChord_px;
  const double off_px =
      std::clamp(kChordShare * std::sqrt(cell_budget / std::max(longest, 1.0)) / std::max(seen, 1e-300),
                 kLeastOfChord_px, most_px);
  const double pixels_per_radius = longest / std::max(reach, 1e-9);
  return std::clamp(std::sqrt(8.0 * off_px / pixels_per_radius), kShortestArcStep, kLongestArcStep);
}

}  // namespace contrejour::inline internal::adaptive
