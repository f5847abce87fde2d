// SPDX-License-Identifier: Apache-2.0
// The options --preset, --save-preset and --session, and the values that a preset or a session changes.
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
  std::string session;  // a file of the studio; empty: none
};

void add_preset_options(CLI::App& command, PresetOptions& options);

// Takes the lens and the values from the session where the command line does not give them, and then from the preset.
// Errors: no such session or preset; no lens given anywhere.
[[nodiscard]] Result<void> fill_from_preset(const PresetOptions& options, std::string& lens, params::Values& values);

// Writes the file of --save-preset, if there is one.
[[nodiscard]] Result<void> save_preset(const PresetOptions& options, const std::string& lens,
                                       const params::Values& values);

}  // namespace contrejour::cli
