#include "cli/bench/tables.h"

#include <fmt/format.h>

#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

std::vector<BenchRequest> requests(const std::vector<std::string>&) {
  std::vector<BenchRequest> list;
  for (const int lights : {1, 2}) {
    for (std::size_t k = 0; k < kMergings; ++k) list.push_back(tiled_merged(lights, k));
  }
  return list;
}

std::string text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"lights", "<system", "none", "paper", "MiB", "paper", "light", "paper", "MiB", "paper", "heavy",
                   "paper", "MiB", "paper"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      std::vector<std::string> cells{fmt::format("{}", lights), std::string(system->name)};
      for (std::size_t k = 0; k < kMergings; ++k) {
        const BenchRow& row = rows.at(*system, tiled_merged(lights, k));
        const double paper = row.paper().primitives[k];
        cells.push_back(count_text(static_cast<double>(row.statistics.primitives_merged)));
        cells.push_back(paper_text(paper, 0));
        cells.push_back(mib_text(static_cast<double>(row.statistics.primitive_bytes)));
        cells.push_back(paper_text(paper * kPaperPrimitiveBytes / (1 << 20), 2));
      }
      table.add(cells);
    }
  }
  return table.text();
}

}  // namespace

const BenchTable kPrimitivesTable{"5", "Table 5: primitives and their memory by merging; MiB: the most held at once",
                                  requests, text};

}  // namespace contrejour::cli
