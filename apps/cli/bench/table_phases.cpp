// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::vector<BenchRequest> phases_requests(const std::vector<std::string>&) {
  return {tiled_of(1), bundle_of(1), tiled_of(2), bundle_of(2)};
}

std::string phases_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"lights", "<system", "tiled: rays, coarse", "paper", "dense", "paper", "traversal", "paper", "total",
                   "paper", "bundle: rays", "paper", "raster", "paper", "total", "paper", "raster ratio", "paper"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      const BenchRow& tiled = rows.at(*system, tiled_of(lights));
      const BenchRow& bundle = rows.at(*system, bundle_of(lights));
      const PaperFigures& p = tiled.paper();
      const double dense_ms = tiled.phase_ms({"dense tiles"});
      const double traversal_ms = tiled.phase_ms({"traversal"});
      const double tiled_ms = total_ms(tiled.statistics);
      const double raster_ms = bundle.phase_ms({"raster", "accumulate"});
      const double bundle_ms = total_ms(bundle.statistics);
      table.add({fmt::format("{}", lights), std::string(system->name), ms_text(tiled_ms - dense_ms - traversal_ms),
                 paper_text(p.tiled_trace_ms, 2), ms_text(dense_ms), paper_text(p.tiled_dense_ms, 2),
                 ms_text(traversal_ms), paper_text(p.tiled_traverse_ms, 2), ms_text(tiled_ms),
                 paper_text(p.tiled_total_ms, 2), ms_text(bundle_ms - raster_ms), paper_text(p.bundle_trace_ms, 2),
                 ms_text(raster_ms), paper_text(p.bundle_raster_ms, 2), ms_text(bundle_ms),
                 paper_text(p.bundle_total_ms, 2), fmt::format("{:.1f}", raster_ms / (dense_ms + traversal_ms)),
                 fmt::format("{:.1f}", p.bundle_raster_ms / (p.tiled_dense_ms + p.tiled_traverse_ms))});
    }
  }
  return table.text();
}

}  // namespace

const BenchTable kPhasesTable{"2",
                              "Table 2: phases and totals, ms; light merge, tiles of 8 and 128. Raster ratio: bundle's "
                              "raster over dense tiles and traversal",
                              phases_requests, phases_text};

}  // namespace contrejour::cli
