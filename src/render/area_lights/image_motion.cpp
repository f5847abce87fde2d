// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/image_motion.h"

#include <cmath>

#include "contrejour/expert/trace.h"
#include "contrejour/light.h"

namespace contrejour::inline internal::area {

LinearMap image_motion_px(const LensState& lens, const Frame& frame, const LightSource& source) {
  constexpr double kStep = 1e-3;
  const auto at = [&](Vec2 tangents) {
    return frame.pixel_from_sensor(
        chief_ray_image_point(lens, offset_source(source, tangents), lens.design_wavelength_nm));
  };
  const double s = 0.5 / kStep;
  const LinearMap map{(at({kStep, 0.0}) - at({-kStep, 0.0})) * s, (at({0.0, kStep}) - at({0.0, -kStep})) * s};
  return std::isfinite(map.x.x + map.x.y + map.y.x + map.y.y) ? map : kZeroMap;
}

}  // namespace contrejour::inline internal::area
