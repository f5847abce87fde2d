// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

using Interpolation = TiledOptions::Interpolation;
constexpr std::array kInPaperOrder{Interpolation::Triangle, Interpolation::MeanValue,
                                   Interpolation::HomogeneousTriangle, Interpolation::Wachspress,
                                   Interpolation::LoopDeRose};

BenchRequest interpolated(std::size_t k) {
  BenchRequest request = tiled_of(1);
  request.tiled.interpolation = kInPaperOrder[k];
  return request;
}

std::vector<BenchRequest> interpolation_requests(const std::vector<std::string>&) {
  std::vector<BenchRequest> list;
  for (std::size_t k = 0; k < kInPaperOrder.size(); ++k) list.push_back(interpolated(k));
  return list;
}

std::string interpolation_text(const BenchRows& rows, const std::vector<std::string>&) {
  TextTable table({"<system", "triangle", "paper", "mean value", "paper", "hom. triangle", "paper", "Wachspress",
                   "paper", "Loop-DeRose", "paper"});
  for (const PaperSystem* system : rows.systems()) {
    std::vector<std::string> cells{std::string(system->name)};
    for (std::size_t k = 0; k < kInPaperOrder.size(); ++k) {
      cells.push_back(ms_text(rows.at(*system, interpolated(k)).phase_ms({"traversal"})));
      cells.push_back(paper_text(system->traverse_ms[k], 2));
    }
    table.add(cells);
  }
  return table.text();
}

}  // namespace

const BenchTable kInterpolationTable{"8", "Table 8: tile traversal by interpolation, ms; one light",
                                     interpolation_requests, interpolation_text};

}  // namespace contrejour::cli
