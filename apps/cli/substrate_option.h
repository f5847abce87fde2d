// SPDX-License-Identifier: Apache-2.0
// The option --glass, the substrate of a coating.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "contrejour/expert/glass.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// text: a glass by name or six digits, an index, or N_D,V_D. Default: N-BK7.
void add_substrate_option(CLI::App& command, std::string& text);
[[nodiscard]] Result<Glass> parse_substrate(const std::string& text);

}  // namespace contrejour::cli
