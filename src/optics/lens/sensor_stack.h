// SPDX-License-Identifier: Apache-2.0
// Plates in front of the sensor, and the sensor as a reflecting surface.
#pragma once

#include "contrejour/lens.h"

namespace contrejour::inline internal {

[[nodiscard]] Result<void> check_sensor_stack(const SensorStack& stack);

// Adds the surfaces behind a lens that is in focus without plates, and moves the sensor by the focus shift of the
// plates (first order). Errors: not enough space between the lens and the sensor.
[[nodiscard]] Result<void> add_sensor_stack(const SensorStack& stack, const SourcePosition& position, LensState& lens);

}  // namespace contrejour::inline internal
