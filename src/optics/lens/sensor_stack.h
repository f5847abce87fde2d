// Plates before the sensor, and the sensor as a surface that reflects.
#pragma once

#include "contrejour/lens.h"

namespace contrejour {

[[nodiscard]] Result<void> check_sensor_stack(const SensorStack& stack);

// Behind a lens in focus whose sensor stands where it would without plates: moves the sensor by what these lengthen the
// way to the focus (first order) and adds the surfaces. Errors: no room between the lens and the sensor.
[[nodiscard]] Result<void> add_sensor_stack(const SensorStack& stack, const SourcePlace& place, LensState& lens);

}  // namespace contrejour
