// SPDX-License-Identifier: Apache-2.0
// The line over the list of ghosts. Thread-safety: pure.
#pragma once

#include <string>
#include <vector>

#include "contrejour/ghost_figures.h"
#include "studio/core/document.h"

namespace contrejour::studio {

// "105 ghosts, 0.67 % of the light; ten carry 72 % of it", or how many of them are drawn and why not all. light: whose
// figures these are, named where there are several; listed: how many of them the list's filter lets through.
[[nodiscard]] std::string summary_of_ghosts(const Document& document, const std::vector<GhostFigures>& figures,
                                            std::size_t light, std::size_t listed);

}  // namespace contrejour::studio
