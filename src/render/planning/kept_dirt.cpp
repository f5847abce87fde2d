// SPDX-License-Identifier: Apache-2.0
#include "render/planning/kept_dirt.h"

namespace contrejour::inline internal {

KeptDirt::Key KeptDirt::key_of(const LensState& lens) {
  const SurfaceState& front = lens.surfaces.front();
  const SurfaceState& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index)];
  return {lens.dirt, lens.stop_radius_mm, stop.semi_diameter_mm, front.z_mm, front.semi_diameter_mm};
}

std::shared_ptr<const DirtField> KeptDirt::field(const LensState& lens) {
  if (!field_) field_ = DirtField::of(lens);
  return field_;
}

}  // namespace contrejour::inline internal
