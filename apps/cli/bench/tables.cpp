// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace contrejour::cli {

std::span<const BenchTable> bench_tables() {
  static const std::array kTables{kOverviewTable,   kPhasesTable,      kQualityTable, kTileSizesTable,
                                  kPrimitivesTable, kIndicesTable,     kMergingTable, kInterpolationTable,
                                  kTargetsTable,    kFullApertureTable};
  return kTables;
}

BenchRequest bundle_of(int lights) { return {lights, "bundle"}; }

BenchRequest tiled_of(int lights) { return {lights, "tiled"}; }

BenchRequest adaptive_of(int lights) { return {lights, "adaptive"}; }

BenchRequest tiled_merged(int lights, std::size_t merging) {
  BenchRequest request = tiled_of(lights);
  if (merging == 0) request.tiled.merge_steps = 0;
  if (merging == 2) request.tiled.merge_threshold = 0.1;
  return request;
}

std::string ms_text(double ms) { return fmt::format("{:.1f}", ms); }
std::string count_text(double count) { return fmt::format("{:.0f}", count); }
std::string mib_text(double bytes) { return fmt::format("{:.2f}", bytes / (1 << 20)); }

std::string db_text(const std::optional<double>& db) {
  if (!db) return "-";
  return std::isfinite(*db) ? fmt::format("{:.2f}", *db) : "equal";
}

std::string paper_text(double value, int digits) {
  return value > 0.0 ? fmt::format("{:.{}f}", value, digits) : std::string("-");
}

}  // namespace contrejour::cli
