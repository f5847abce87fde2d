// SPDX-License-Identifier: Apache-2.0
// What messages about names that are not known need.
#pragma once

#include <string>
#include <string_view>

#include "contrejour/expert/nearest_name.h"

namespace contrejour::inline internal {

// Insertions, deletions, replacements and swaps of neighbours that make b of a (optimal string alignment).
// Cost: a.size() * b.size(); callers shorten what a user typed.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

// At most 60 bytes for an error message, cut between characters, control characters replaced.
[[nodiscard]] std::string shortened(std::string_view name);

}  // namespace contrejour::inline internal
