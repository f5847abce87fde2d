// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/tables.h"

#include <fmt/format.h>

namespace contrejour::cli {
namespace {

BenchRequest wide_open(BenchRequest request) {
  request.variant.full_aperture = true;
  return request;
}

std::vector<BenchRequest> full_aperture_requests(const std::vector<std::string>&) {
  return {wide_open(adaptive_of(1)), wide_open(bundle_of(1)), wide_open(tiled_of(1))};
}

std::vector<Target> full_aperture_targets(const BenchRows& rows) {
  std::vector<Target> list;
  for (const BenchRequest& slow : {bundle_of(1), tiled_of(1)}) {
    for (const PaperSystem* system : rows.systems()) {
      const BenchRow& adaptive = rows.at(*system, wide_open(adaptive_of(1)));
      Target target = speed_target(rows.at(*system, wide_open(slow)), adaptive, 5.0, 20.0);
      target.name += fmt::format(" at f/{:.3g}", adaptive.f_number);
      list.push_back(target);
    }
  }
  return list;
}

std::string full_aperture_text(const BenchRows& rows, const std::vector<std::string>&) {
  return targets_text(full_aperture_targets(rows));
}

}  // namespace

const BenchTable kFullApertureTable{"full-aperture",
                                    "Targets at each lens's widest aperture, one light; bundle and tiled run once",
                                    full_aperture_requests, full_aperture_text, full_aperture_targets};

}  // namespace contrejour::cli
