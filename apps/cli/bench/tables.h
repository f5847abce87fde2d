// SPDX-License-Identifier: Apache-2.0
// The tables that `bench tables` can print. A new one is a file with these two functions and a line in tables.cpp.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/bench/rows.h"
#include "cli/bench/target.h"

namespace contrejour::cli {

struct BenchTable {
  std::string_view key;  // for --tables
  std::string_view title;
  // The measurements of every system that the table needs. `methods` are those that the user selected, for a table that
  // lists any method.
  std::vector<BenchRequest> (*requests)(const std::vector<std::string>& methods);
  std::string (*text)(const BenchRows& rows, const std::vector<std::string>& methods);
  std::vector<Target> (*targets)(const BenchRows& rows) = nullptr;  // null: it has none
  bool needs_probes = false;
};

[[nodiscard]] std::span<const BenchTable> bench_tables();

// Requests that several tables make.
[[nodiscard]] BenchRequest bundle_of(int lights);
[[nodiscard]] BenchRequest adaptive_of(int lights);
[[nodiscard]] BenchRequest tiled_of(int lights);  // light merge, 8 and 128 pixels, Loop-DeRose
[[nodiscard]] BenchRequest tiled_merged(int lights, std::size_t merging);  // none, light, heavy
inline constexpr std::size_t kMergings = 3;

// Texts of cells. A figure that is missing in the paper, or was not measured, is a dash.
[[nodiscard]] std::string ms_text(double ms);
[[nodiscard]] std::string count_text(double count);
[[nodiscard]] std::string mib_text(double bytes);
[[nodiscard]] std::string db_text(const std::optional<double>& db);
[[nodiscard]] std::string paper_text(double value, int digits);

extern const BenchTable kOverviewTable, kPhasesTable, kQualityTable, kTileSizesTable, kPrimitivesTable, kIndicesTable,
    kMergingTable, kInterpolationTable, kTargetsTable, kFullApertureTable;

}  // namespace contrejour::cli
