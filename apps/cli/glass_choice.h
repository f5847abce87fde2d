// SPDX-License-Identifier: Apache-2.0
// The glasses that a command uses: the user's own catalogues, then the bundled one.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/glass_catalogue.h"

namespace contrejour::cli {

// Adds --catalogue PATH, which may be repeated.
void add_catalogue_option(CLI::App& command, std::vector<std::string>& paths);

// Reads `paths`, then those of the environment variable CONTREJOUR_GLASS_PATH (separated by ':', or by ';' on Windows).
// Prints the files' warnings. Errors: those of GlassCatalogue::add_path.
[[nodiscard]] Result<GlassCatalogue> own_glasses(const std::vector<std::string>& paths = {});

// own_glasses() followed by the bundled ones.
[[nodiscard]] Result<GlassCatalogue> all_glasses(const std::vector<std::string>& paths = {});

}  // namespace contrejour::cli
