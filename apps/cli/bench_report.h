// Rows of `bench tables` as JSON and as a table, beside the paper's figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/paper_figures.h"
#include "contrejour/render.h"

namespace contrejour::cli {

struct BenchRow {
  const PaperSystem* system = nullptr;
  int lights = 1;
  RenderSettings settings;
  RenderStatistics statistics;    // of the fastest run
  int runs = 1;
  std::optional<double> psnr_db;  // against `reference`, if asked for; infinite when equal
};

[[nodiscard]] Json bench_json(const std::vector<BenchRow>& rows);
[[nodiscard]] std::string bench_text(const std::vector<BenchRow>& rows);

}  // namespace contrejour::cli
