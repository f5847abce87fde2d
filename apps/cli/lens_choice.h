// SPDX-License-Identifier: Apache-2.0
// The lens that a command uses: a bundled name or a file, configured by the options.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/lens.h"

namespace contrejour::cli {

// Adds the LENS argument.
CLI::Option* add_lens_argument(CLI::App& command, std::string& lens);

// Calls find_lens() with the user's own glasses (glass_choice.h), or takes the lens of a session (session.h).
[[nodiscard]] Result<Prescription> prescription_of(const std::string& lens);

// Finds and configures the lens; prints its warnings. Errors: those of find_lens and configure_lens.
[[nodiscard]] Result<LensState> open_lens(const std::string& lens, const params::Values& values);

// An option that names a ghost, such as --ghost I-J, and the ghost that it names. Errors: the lens has no such ghost.
CLI::Option* add_ghost_option(CLI::App& command, const std::string& flag, std::string& ghost, const std::string& help);
[[nodiscard]] Result<Ghost> choose_ghost(const LensState& lens, const std::string& text);

// An option for any number of ghosts, and the ghosts that it names.
CLI::Option* add_ghosts_option(CLI::App& command, std::vector<std::string>& ghosts, const std::string& help);
[[nodiscard]] Result<std::vector<Ghost>> choose_ghosts(const LensState& lens, const std::string& text);

// --wavelength, or the lens's own.
[[nodiscard]] double wavelength_nm(const params::Values& values, const LensState& lens);

}  // namespace contrejour::cli
