// SPDX-License-Identifier: Apache-2.0
// Chief rays of lenses with surfaces that are not surfaces of revolution: docs/physics/surfaces.md.
#pragma once

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {

[[nodiscard]] bool is_anamorphic(const LensState& lens);

// As chief_ray_image_point and direction_for_image_point.
[[nodiscard]] Vec2 anamorphic_image_point(const LensState& lens, const LightSource& source, double lambda_nm);
[[nodiscard]] Vec3 anamorphic_direction(const LensState& lens, Vec2 sensor_mm, double lambda_nm, double distance_mm);

}  // namespace contrejour::inline internal
