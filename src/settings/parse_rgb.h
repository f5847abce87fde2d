// SPDX-License-Identifier: Apache-2.0
// Parses colours given per channel. Thread-safety: a pure function.
#pragma once

#include <string_view>

#include "contrejour/expert/colour.h"
#include "contrejour/result.h"

namespace contrejour::params {

// "R,G,B": three numbers from 0 to `max`. Errors: InvalidArgument.
[[nodiscard]] Result<Rgb> parse_rgb(std::string_view text, double max);

}  // namespace contrejour::params
