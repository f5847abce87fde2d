// What `apply` found in the picture: as JSON, or as a table.
#pragma once

#include <string>

#include "cli/console.h"
#include "params/flare_plan.h"

namespace contrejour::cli {

[[nodiscard]] Json report_json(const params::FlarePlan& plan);
[[nodiscard]] std::string report_text(const params::FlarePlan& plan);

}  // namespace contrejour::cli
