// SPDX-License-Identifier: Apache-2.0
#include "cli/flare_report.h"

namespace contrejour::cli {

double total_ms(const RenderStatistics& statistics) {
  for (const auto& [phase, ms] : statistics.time_ms) {
    if (phase == "total") return ms;
  }
  return 0.0;
}

Json times_json(const RenderStatistics& statistics) {
  Json times = {{"total", total_ms(statistics)}};
  for (const auto& [phase, ms] : statistics.time_ms) times[phase] = ms;
  return times;
}

Json stats_json(const RenderStatistics& statistics) {
  const auto& skipped_flux = statistics.ghosts_skipped_flux;
  const Json skipped = skipped_flux ? Json(*skipped_flux) : Json();
  return {{"method", statistics.method},
          {"device", statistics.device},
          {"time_ms", times_json(statistics)},
          {"rays", statistics.rays},
          {"surface_hits", statistics.surface_hits},
          {"primitives", statistics.primitives},
          {"primitives_merged", statistics.primitives_merged},
          {"tile_indices", statistics.tile_indices},
          {"primitive_bytes", statistics.primitive_bytes},
          {"tile_list_bytes", statistics.tile_list_bytes},
          {"ghosts_rendered", statistics.ghosts_rendered},
          {"ghosts_skipped_flux", skipped},
          {"traced_flux", statistics.traced_flux ? Json(*statistics.traced_flux) : Json()},
          {"peak_memory_bytes", statistics.peak_memory_bytes},
          {"device_invocations", statistics.device_invocations},
          {"device_bytes", statistics.device_bytes}};
}

}  // namespace contrejour::cli
