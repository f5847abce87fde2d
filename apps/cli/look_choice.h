// SPDX-License-Identifier: Apache-2.0
// The options --look and --save-look, and the values that a preset changes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "contrejour/look.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct LookOptions {
  std::string look;  // a bundled name or a file; empty: none
  std::string save;  // a file; empty: none
};

void add_look_options(CLI::App& command, LookOptions& options);

// Takes the lens and the values from the preset where the command line does not give them. Errors: no such preset; no
// lens given anywhere.
[[nodiscard]] Result<void> fill_from_look(const LookOptions& options, std::string& lens, params::Values& values);

}  // namespace contrejour::cli
