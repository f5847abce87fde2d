// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/rows.h"

#include <algorithm>
#include <cassert>

#include "cli/flare_report.h"

namespace contrejour::cli {

bool same(const BenchRequest& a, const BenchRequest& b) {
  if (a.lights != b.lights || a.method != b.method || a.variant != b.variant) return false;
  return a.method != "tiled" ||
         (a.tiled.merge_steps == b.tiled.merge_steps && a.tiled.merge_threshold == b.tiled.merge_threshold &&
          a.tiled.dense_tile == b.tiled.dense_tile && a.tiled.coarse_tile == b.tiled.coarse_tile &&
          a.tiled.interpolation == b.tiled.interpolation);
}

double BenchRow::phase_ms(std::initializer_list<std::string_view> phases) const {
  double sum = 0.0;
  for (const auto& [phase, ms] : statistics.time_ms) {
    if (std::find(phases.begin(), phases.end(), phase) != phases.end()) sum += ms;
  }
  return sum;
}

void BenchRows::add_again(const BenchRow& row) {
  const auto is_same = [&](const BenchRow& other) {
    return other.system == row.system && same(other.request, row.request);
  };
  const auto found = std::find_if(rows_.begin(), rows_.end(), is_same);
  assert(found != rows_.end());
  found->runs += row.runs;
  if (total_ms(row.statistics) < total_ms(found->statistics)) found->statistics = row.statistics;
}

const BenchRow& BenchRows::at(const PaperSystem& system, const BenchRequest& request) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const BenchRow& row) {
    return row.system == &system && same(row.request, request);
  });
  assert(found != rows_.end());
  return *found;
}

const BenchProbe& BenchRows::probe_of(const PaperSystem& system) const {
  const auto found =
      std::find_if(probes_.begin(), probes_.end(), [&](const BenchProbe& probe) { return probe.system == &system; });
  assert(found != probes_.end());
  return *found;
}

std::vector<const PaperSystem*> BenchRows::systems() const {
  std::vector<const PaperSystem*> list;
  for (const PaperSystem& system : paper_systems()) {
    const auto is_its = [&](const BenchRow& row) { return row.system == &system; };
    if (std::any_of(rows_.begin(), rows_.end(), is_its)) list.push_back(&system);
  }
  return list;
}

}  // namespace contrejour::cli
