// SPDX-License-Identifier: Apache-2.0
// Sizes of sensors and film gates by name.
#pragma once

#include <span>
#include <string_view>

#include "contrejour/result.h"

namespace contrejour::params {

struct SensorFormat {
  std::string_view name;
  double width_mm = 0, height_mm = 0;
};

// The sizes of the exposed areas, before any crop.
[[nodiscard]] std::span<const SensorFormat> sensor_formats();

// Accepts "super35", or a size in mm: "24.9x18.7". Errors: InvalidArgument, with the names.
[[nodiscard]] Result<SensorFormat> parse_sensor(std::string_view text);

}  // namespace contrejour::params
