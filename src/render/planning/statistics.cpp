// SPDX-License-Identifier: Apache-2.0
#include "render/planning/statistics.h"

#include <algorithm>

namespace contrejour::inline internal {
namespace {

using Phases = std::vector<std::pair<std::string, double>>;

Phases::iterator find_phase(Phases& phases, const std::string& name) {
  return std::ranges::find(phases, name, &Phases::value_type::first);
}

// The position of the total, after adding the time to it.
Phases::iterator total_with(Phases& phases, double ms) {
  const auto total = find_phase(phases, "total");
  if (total != phases.end()) total->second += ms;
  return total;
}

}  // namespace

void add(RenderStatistics& sum, const RenderStatistics& one) {
  sum.method = one.method;
  sum.device = one.device;
  if (one.traced_flux) sum.traced_flux = std::max(sum.traced_flux.value_or(0.0), *one.traced_flux);
  sum.rays += one.rays;
  sum.surface_hits += one.surface_hits;
  sum.primitives += one.primitives;
  sum.primitives_merged += one.primitives_merged;
  sum.tile_indices += one.tile_indices;
  sum.primitive_bytes = std::max(sum.primitive_bytes, one.primitive_bytes);
  sum.tile_list_bytes = std::max(sum.tile_list_bytes, one.tile_list_bytes);
  for (const auto& [phase, ms] : one.time_ms) {
    const auto same = find_phase(sum.time_ms, phase);
    if (same != sum.time_ms.end())
      same->second += ms;
    else
      sum.time_ms.emplace_back(phase, ms);
  }
}

void count_first(RenderStatistics& statistics, const char* phase, double ms) {
  total_with(statistics.time_ms, ms);
  statistics.time_ms.insert(statistics.time_ms.begin(), {phase, ms});
}

void count_last(RenderStatistics& statistics, const char* phase, double ms) {
  statistics.time_ms.insert(total_with(statistics.time_ms, ms), {phase, ms});
}

}  // namespace contrejour::inline internal
