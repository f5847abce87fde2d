// SPDX-License-Identifier: Apache-2.0
// A light's brightness in terms of photography and lighting -> the sum of its direct image over its pixels. White is 1.
// For a disc, stops count from white; lux at the lens, candela and nits (cd/m^2) use the exposure: a surface whose
// light makes H lx s on the sensor has the value H / (55.6 / ISO), so that 0.18 is the 10 / ISO lx s of ISO 12232's
// standard output sensitivity.
// Thread-safety: pure functions.
#pragma once

#include <string_view>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour::params {

struct Exposure {
  double iso = 100.0;
  double shutter_s = 0.02;
};

// docs/physics/radiometry.md, "Brightness of lights". Uses the light's position and size, not its value. Errors:
// InvalidArgument for stops and nits of a point and candela of a distant light.
[[nodiscard]] Result<double> sum_of(const LightValue& value, const Light& light, const LensState& lens,
                                    const Frame& frame, const Exposure& exposure);

[[nodiscard]] Result<double> parse_shutter(std::string_view text);  // "1/50", "0.02": seconds

}  // namespace contrejour::params
