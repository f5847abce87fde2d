// SPDX-License-Identifier: Apache-2.0
// Dirt at the points where a ghost's rays cross it.
#pragma once

#include <memory>

#include "ghosts/light_frame.h"
#include "render/stop_patterns/band_dirt.h"

namespace contrejour::inline internal::adaptive {

// The point, in the lens's frame, at which a ray crosses the front. entrance_mm: in the plane z = z_mm, in the light's
// frame.
[[nodiscard]] inline Vec2 front_point_of(const DirtSite& dirt, const LightFrame& light, double z_mm, Vec2 entrance_mm) {
  return light.to_lens_frame(dirt.front_point(entrance_mm, z_mm, light.source));
}

struct DirtView {
  std::shared_ptr<const stop_patterns::BandDirt> band = nullptr;  // null: no shadows are drawn
  const LightFrame* light = nullptr;
  double entrance_z_mm = 0.0;  // plane of the rays' coordinates

  [[nodiscard]] explicit operator bool() const { return band != nullptr; }
  [[nodiscard]] const DirtSite& site() const { return band->first().site(); }
  [[nodiscard]] Vec2 front_point_of(Vec2 entrance_mm) const {
    return adaptive::front_point_of(site(), *light, entrance_z_mm, entrance_mm);
  }
};

}  // namespace contrejour::inline internal::adaptive
