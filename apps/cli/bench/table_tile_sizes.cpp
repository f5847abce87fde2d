// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

// In the paper's order: 8 x 8 without and with coarse tiles, then 16 x 16 without and with them.
BenchRequest of_tiles(std::size_t k) {
  BenchRequest request = tiled_of(1);
  request.tiled.dense_tile = k < 2 ? 8 : 16;
  request.tiled.coarse_tile = k % 2 == 0 ? 0 : 128;
  return request;
}

std::vector<BenchRequest> tile_sizes_requests(const std::vector<std::string>&) {
  std::vector<BenchRequest> list;
  for (std::size_t k = 0; k < 4; ++k) list.push_back(of_tiles(k));
  return list;
}

std::string tile_sizes_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"<system", "8, no coarse", "paper", "8, coarse", "paper", "16, no coarse", "paper", "16, coarse",
                   "paper", "<tile lists and traversal alone, of the four"});
  for (const PaperSystem* system : rows.systems()) {
    std::vector<std::string> cells{std::string(system->name)};
    std::string alone;
    for (std::size_t k = 0; k < 4; ++k) {
      const BenchRow& row = rows.at(*system, of_tiles(k));
      cells.push_back(ms_text(total_ms(row.statistics)));
      cells.push_back(paper_text(system->tiles_ms[k], 2));
      alone += (k > 0 ? ", " : "") + ms_text(row.phase_ms({"coarse tiles", "dense tiles", "traversal"}));
    }
    cells.push_back(alone);
    table.add(cells);
  }
  return table.text();
}

}  // namespace

const BenchTable kTileSizesTable{"4", "Table 4: total ms by tile size, without and with coarse tiles of 128; one light",
                                 tile_sizes_requests, tile_sizes_text};

}  // namespace contrejour::cli
