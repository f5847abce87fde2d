// SPDX-License-Identifier: Apache-2.0
// Draws a section as SVG.
#pragma once

#include <string>

#include "cli/section.h"

namespace contrejour::cli {

[[nodiscard]] std::string draw_section(const Section& section);

}  // namespace contrejour::cli
