// Finds what a user may have meant by a name that is not known.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contrejour {

// Insertions, deletions, replacements and swaps of neighbours that make b of a (optimal string alignment).
// Cost: a.size() * b.size(); callers shorten what a user typed.
[[nodiscard]] int edit_distance(std::string_view a, std::string_view b);

// The known name nearest to `name`, letter case aside, or empty if none is near.
[[nodiscard]] std::string nearest_name(std::string_view name, const std::vector<std::string_view>& known);

// At most 60 bytes for an error message, cut between characters, control characters replaced.
[[nodiscard]] std::string shortened(std::string_view name);

}  // namespace contrejour
