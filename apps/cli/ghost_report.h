// SPDX-License-Identifier: Apache-2.0
// The properties of ghosts as a table, as comma-separated values and as JSON.
#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "contrejour/ghost_figures.h"

namespace contrejour::cli {

enum class GhostOrder { Flux, Peak, Size, Focus };  // brightest (Flux, Peak), smallest or nearest to focus first

void sort_ghosts(std::vector<GhostFigures>& figures, GhostOrder order);

// Pairs in the order of the reflections: light meets the second surface of each pair first.
[[nodiscard]] Json surfaces_json(const Ghost& ghost);

// The name as a field of comma-separated values: a diffraction order has a comma within the name.
[[nodiscard]] std::string csv_name(const Ghost& ghost);

[[nodiscard]] Json ghosts_json(const std::vector<GhostFigures>& figures);
[[nodiscard]] std::string ghosts_text(const std::vector<GhostFigures>& figures);
[[nodiscard]] std::string ghosts_csv(const std::vector<GhostFigures>& figures);

}  // namespace contrejour::cli
