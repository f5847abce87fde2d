// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::vector<BenchRequest> merging_requests(const std::vector<std::string>&) {
  std::vector<BenchRequest> list{bundle_of(1)};
  for (std::size_t k = 0; k < kMergings; ++k) list.push_back(tiled_merged(1, k));
  return list;
}

std::string merging_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"<system", "none ms", "paper", "dB", "paper", "light ms", "paper", "dB", "paper", "dB vs none",
                   "heavy ms", "paper", "dB", "paper", "dB vs none"});
  for (const PaperSystem* system : rows.systems()) {
    std::vector<std::string> cells{std::string(system->name)};
    for (std::size_t k = 0; k < kMergings; ++k) {
      const BenchRow& row = rows.at(*system, tiled_merged(1, k));
      cells.push_back(ms_text(total_ms(row.statistics)));
      cells.push_back(paper_text(system->merging_ms[k], 2));
      cells.push_back(db_text(row.bundle_db));
      cells.push_back(paper_text(system->merging_db[k], 2));
      if (k > 0) cells.push_back(db_text(row.unmerged_db));
    }
    table.add(cells);
  }
  return table.text();
}

}  // namespace

const BenchTable kMergingTable{"7",
                               "Table 7: merging, total ms and PSNR relative to bundle, dB; one light. dB vs none: "
                               "relative to the picture without merging",
                               merging_requests, merging_text};

}  // namespace contrejour::cli
