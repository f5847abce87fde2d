// SPDX-License-Identifier: Apache-2.0
// The fit of merged stations, for the commands that make one.
#pragma once

#include <string>

#include "cli/flare_table.h"
#include "contrejour/expert/fit_comparison.h"
#include "contrejour/expert/parameter_values.h"

namespace contrejour::cli {

struct FitRequest {
  std::string folder;   // of merged stations
  std::string output;   // the flare's file
  std::string report;   // HTML; empty: none, and likewise below
  std::string csv;      // the stations' figures
  std::string compare;  // the comparison with walch2018's descent, as SVG or CSV
  std::string name;     // of the flare; empty: the output's
  std::string lens;     // whose ghosts the fit starts from; empty: from none
  params::Values lens_values;
  CaptureExposure exposure;  // of the photographs; 0: not given
  FlareFitOptions fit;
  ComparisonSettings comparison;
  bool with_comparison = false;  // in the report, too
  int threads = 0;
};

struct FitResult {
  FitOutcome outcome;
  std::optional<FitComparison> comparison;
};

// Reads, fits and writes all files, or none. Warnings are printed. Errors: those of reading, fitting and writing.
[[nodiscard]] Result<FitResult> fit_merged(FitRequest request);

}  // namespace contrejour::cli
