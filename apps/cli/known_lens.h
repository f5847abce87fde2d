// SPDX-License-Identifier: Apache-2.0
// A known lens and the merged stations that show it, for the commands that learn about it from them.
#pragma once

#include <memory>
#include <string>

#include "contrejour/expert/learn_lens.h"
#include "contrejour/expert/merged_sweep.h"
#include "contrejour/expert/parameter_values.h"

namespace CLI {
class App;
}

namespace contrejour::cli {

struct KnownLensOptions {
  std::string lens, folder, output;
  double source_size_deg = 0.5, pixel_um = 0.0;
  int threads = 0;
  bool json = false;
  params::Values values;  // of the lens
};

// Arguments LENS and FOLDER, -o, and what the photographs were taken with.
void add_known_lens(CLI::App& command, KnownLensOptions& options);

struct KnownLens {
  MergedSweep merged;
  LensPhotographs photographs;
};
// Reads both; prints what could not be read. Errors: those of the lens, of its settings and of merged stations.
[[nodiscard]] Result<KnownLens> open_known_lens(const KnownLensOptions& options);

[[nodiscard]] Result<void> write_learnt_lens(const std::string& file, const Prescription& lens);

}  // namespace contrejour::cli
