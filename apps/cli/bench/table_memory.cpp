// SPDX-License-Identifier: Apache-2.0
// bodonyi2023 tables 5 and 6: the memory that remains after merging.
#include "cli/bench/tables.h"

#include <fmt/format.h>

#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

// A count and its bytes, ours and the paper's.
struct Stored {
  double count = 0, bytes = 0, paper_count = 0, paper_bytes = 0;
};

Stored primitives(const BenchRow& row, std::size_t merging) {
  const double paper = row.paper().primitives[merging];
  return {static_cast<double>(row.statistics.primitives_merged), static_cast<double>(row.statistics.primitive_bytes),
          paper, paper * kPaperPrimitiveBytes};
}

Stored indices(const BenchRow& row, std::size_t merging) {
  const double paper = row.paper().indices[merging];
  return {static_cast<double>(row.statistics.tile_indices), static_cast<double>(row.statistics.tile_list_bytes), paper,
          paper * kPaperIndexBytes};
}

std::vector<BenchRequest> memory_requests(const std::vector<std::string>&) {
  std::vector<BenchRequest> list;
  for (const int lights : {1, 2}) {
    for (std::size_t k = 0; k < kMergings; ++k) list.push_back(tiled_merged(lights, k));
  }
  return list;
}

template <auto stored>
std::string memory_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"lights", "<system", "none", "paper", "MiB", "paper", "light", "paper", "MiB", "paper", "heavy",
                   "paper", "MiB", "paper"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      std::vector<std::string> cells{fmt::format("{}", lights), std::string(system->name)};
      for (std::size_t k = 0; k < kMergings; ++k) {
        const Stored s = stored(rows.at(*system, tiled_merged(lights, k)), k);
        cells.push_back(count_text(s.count));
        cells.push_back(paper_text(s.paper_count, 0));
        cells.push_back(mib_text(s.bytes));
        cells.push_back(paper_text(s.paper_bytes / (1 << 20), 2));
      }
      table.add(cells);
    }
  }
  return table.text();
}

}  // namespace

const BenchTable kPrimitivesTable{"5", "Table 5: primitives and their memory by merging; MiB: the maximum held at once",
                                  memory_requests, memory_text<primitives>};
const BenchTable kIndicesTable{
    "6", "Table 6: entries of the dense tiles' lists and their memory by merging; MiB: the maximum held at once",
    memory_requests, memory_text<indices>};

}  // namespace contrejour::cli
