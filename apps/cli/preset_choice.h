// SPDX-License-Identifier: Apache-2.0
// The options --preset and --save-preset, and the values that a preset changes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "contrejour/preset.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct PresetOptions {
  std::string name;  // a bundled preset or a file; empty: none
  std::string save;  // a file; empty: none
};

void add_preset_options(CLI::App& command, PresetOptions& options);

// Takes the lens and the values from the preset where the command line does not give them. Errors: no such preset; no
// lens given anywhere.
[[nodiscard]] Result<void> fill_from_preset(const PresetOptions& options, std::string& lens, params::Values& values);

// Writes the file of --save-preset, if there is one.
[[nodiscard]] Result<void> save_preset(const PresetOptions& options, const std::string& lens,
                                       const params::Values& values);

}  // namespace contrejour::cli
