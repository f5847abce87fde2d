// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "cli/bench/hullin.h"
#include "cli/bench/report.h"
#include "cli/text_table.h"

namespace contrejour::cli {

std::string hullin_text(const HullinFigure& figure, const std::vector<HullinRow>& rows) {
  TextTable table({"<lens", "f/", "<rendered", "ghosts", "ms", "frames/s", "paper ms", "PSNR dB", "<"});
  for (const HullinRow& row : rows) {
    table.add({row.lens, fmt::format("{:.1f}", row.f_number), row.what, fmt::format("{}", row.ghosts),
               fmt::format("{:.1f}", row.ms), fmt::format("{:.1f}", 1e3 / row.ms),
               row.paper_ms > 0.0 ? fmt::format("{:.4g}", row.paper_ms) : "",
               row.psnr_db ? fmt::format("{:.1f}", *row.psnr_db) : "", row.note});
  }
  return fmt::format("{}\n{}", figure.title, table.text());
}

Json hullin_json(const std::vector<HullinRow>& rows) {
  Json list = Json::array();
  for (const HullinRow& row : rows) {
    list.push_back({{"figure", row.figure},
                    {"lens", row.lens},
                    {"f_number", row.f_number},
                    {"rendered", row.what},
                    {"ghosts_rendered", row.ghosts},
                    {"time_ms", row.ms},
                    {"paper_ms", row.paper_ms > 0.0 ? Json(row.paper_ms) : Json()},
                    {"psnr_db", row.psnr_db ? Json(*row.psnr_db) : Json()},
                    {"note", row.note}});
  }
  return {{"machine", machine_text()}, {"rows", std::move(list)}};
}

}  // namespace contrejour::cli
