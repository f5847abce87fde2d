// SPDX-License-Identifier: Apache-2.0
// The result of a fit as text, JSON and CSV.
#pragma once

#include <string>

#include "cli/console.h"
#include "contrejour/expert/fit_flare.h"

namespace contrejour::cli {

struct FitOutcome {
  std::string name;  // of the flare
  SweepGeometry geometry;
  FittedFlare fit;
  double seconds = 0;
};

// RMS of fitted over captured flux - 1, over the stations.
[[nodiscard]] double flux_error(const FittedFlare& fit);

[[nodiscard]] std::string fit_text(const FitOutcome& outcome);
[[nodiscard]] Json fit_json(const FitOutcome& outcome);
[[nodiscard]] std::string stations_csv(const FittedFlare& fit);

}  // namespace contrejour::cli
