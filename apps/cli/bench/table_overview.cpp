// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::string millions(double count) { return fmt::format("{:.2f}", count * 1e-6); }

std::string phase_times_text(const RenderStatistics& statistics) {
  std::string text;
  for (const auto& [phase, ms] : statistics.time_ms) {
    if (phase != "total") text += fmt::format("{}{} {:.0f}", text.empty() ? "" : ", ", phase, ms);
  }
  return text;
}

double paper_total_ms(const BenchRow& row) {
  return row.request.method == "bundle" ? row.paper().bundle_total_ms : row.paper().tiled_total_ms;
}

std::vector<BenchRequest> overview_requests(const std::vector<std::string>& methods) {
  std::vector<BenchRequest> list;
  for (const int lights : {1, 2}) {
    for (const std::string& method : methods) list.push_back({lights, method});
  }
  return list;
}

std::string overview_text(const BenchRows& rows, const std::vector<std::string>& methods) {
  TextTable table({"<system", "f/", "lights", "<method", "total ms", "paper ms", "dB vs reference", "M rays", "M hits",
                   "M primitives", "paper M", "<by phase, ms"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      for (const std::string& method : methods) {
        const BenchRow& row = rows.at(*system, {lights, method});
        const RenderStatistics& s = row.statistics;
        table.add({std::string(system->name), fmt::format("{:g}", system->f_number), fmt::format("{}", lights), method,
                   ms_text(total_ms(s)), paper_text(paper_total_ms(row), 2), db_text(row.reference_db),
                   millions(static_cast<double>(s.rays)), millions(static_cast<double>(s.surface_hits)),
                   millions(static_cast<double>(s.primitives)), millions(row.paper().primitives[0]),
                   phase_times_text(s)});
      }
    }
  }
  return table.text();
}

}  // namespace

const BenchTable kOverviewTable{
    "overview",
    "All methods; the paper's total is that of its previous method for bundle, else that of its tiled method",
    overview_requests, overview_text};

}  // namespace contrejour::cli
