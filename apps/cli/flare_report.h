// SPDX-License-Identifier: Apache-2.0
// A renderer's statistics as JSON, with the names of `render --stats`.
#pragma once

#include "cli/console.h"
#include "contrejour/render.h"

namespace contrejour::cli {

[[nodiscard]] Json stats_json(const RenderStatistics& statistics);
[[nodiscard]] Json times_json(const RenderStatistics& statistics);  // the total first, then the phases
[[nodiscard]] double total_ms(const RenderStatistics& statistics);

}  // namespace contrejour::cli
