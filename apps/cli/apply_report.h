// SPDX-License-Identifier: Apache-2.0
// Reports the lights that `apply` detected in a photograph, and how visible their flare is, as JSON or as text.
#pragma once

#include <string>

#include "cli/console.h"
#include "contrejour/expert/flare_plan.h"
#include "contrejour/expert/flare_visibility.h"

namespace contrejour::cli {

[[nodiscard]] Json report_json(const FlarePlan& plan);
[[nodiscard]] std::string report_text(const FlarePlan& plan);

[[nodiscard]] Json visibility_json(const FlareVisibility& visibility);
[[nodiscard]] std::string visibility_text(const FlareVisibility& visibility, std::size_t lights);

}  // namespace contrejour::cli
