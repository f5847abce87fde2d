// SPDX-License-Identifier: Apache-2.0
// A glass as users write it. Thread-safety: pure.
#pragma once

#include <string_view>

#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour::params {

// "N-BK7" or "SCHOTT N-BK7", a code of six digits ("517642"), an index ("1.52"), n_d and Abbe number ("1.5168,64.17"),
// or "air". Errors: InvalidArgument, naming the nearest glass.
[[nodiscard]] CONTREJOUR_API Result<Glass> parse_glass(std::string_view text,
                                                       const GlassCatalogue& glasses = bundled_glasses());

}  // namespace contrejour::params
