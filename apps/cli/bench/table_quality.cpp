// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include <fmt/format.h>

#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::vector<BenchRequest> quality_requests(const std::vector<std::string>&) {
  return {tiled_of(1), bundle_of(1), tiled_of(2), bundle_of(2)};
}

std::string quality_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"lights", "<system", "tiled vs bundle", "paper", "tiled vs reference", "bundle vs reference"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      const BenchRow& tiled = rows.at(*system, tiled_of(lights));
      table.add({fmt::format("{}", lights), std::string(system->name), db_text(tiled.bundle_db),
                 paper_text(tiled.paper().tiled_psnr_db, 2), db_text(tiled.reference_db),
                 db_text(rows.at(*system, bundle_of(lights)).reference_db)});
    }
  }
  return table.text();
}

}  // namespace

const BenchTable kQualityTable{"3", "Table 3: PSNR, dB (clipped at the 99.9th percentile of the picture compared with)",
                               quality_requests, quality_text};

}  // namespace contrejour::cli
