// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/dirt_shadows.h"

#include <algorithm>
#include <utility>

namespace contrejour::inline internal {

DirtShadows::DirtShadows(std::shared_ptr<const DirtField> field,
                         std::vector<std::shared_ptr<const stop_patterns::DirtDiffraction>> fringes)
    : field_(std::move(field)), fringes_(std::move(fringes)) {
  for (const auto& plane : fringes_)
    if (plane) level_ *= plane->level();
}

double DirtShadows::transmission(const DirtPoint& point, std::size_t crossing) const {
  const auto* const fringes = fringes_at(crossing);
  return fringes != nullptr ? fringes->transmission(point.at_mm, point.width_mm) : field_->transmission(point);
}

bool DirtShadows::is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const {
  const auto* const fringes = fringes_at(crossing);
  return fringes != nullptr ? fringes->is_clean(middle_mm, radius_mm) : field_->is_clean(middle_mm, radius_mm);
}

DirtEdges DirtShadows::edges() const {
  DirtEdges edges = field_->edges();
  for (const auto& plane : fringes_)
    if (plane) edges.edge_width_mm = std::max(edges.edge_width_mm, plane->fringe_unit_mm());
  return edges;
}

}  // namespace contrejour::inline internal
