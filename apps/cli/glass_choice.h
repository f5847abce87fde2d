// The glasses a command works with: the user's own catalogues, then the bundled one.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/glass_catalogue.h"

namespace contrejour::cli {

// --catalogue PATH, which may be repeated.
void add_catalogue_option(CLI::App& command, std::vector<std::string>& paths);

// `paths`, then those of the environment variable CONTREJOUR_GLASS_PATH (with ':' between, ';' on Windows). Prints the
// files' warnings. Errors: those of GlassCatalogue::add_path.
[[nodiscard]] Result<GlassCatalogue> own_glasses(const std::vector<std::string>& paths = {});

// own_glasses() with the bundled ones behind.
[[nodiscard]] Result<GlassCatalogue> all_glasses(const std::vector<std::string>& paths = {});

}  // namespace contrejour::cli
