// SPDX-License-Identifier: Apache-2.0
// The nearest of some names to one that is not known, for "did you mean". Thread-safety: a pure function.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"

namespace contrejour {

// The known name nearest to `name`, letter case aside: one that contains it (three letters or more), or the one that
// the fewest insertions, deletions, replacements and swaps of neighbours make of it. Empty if that takes more of them
// than a third of the name's letters and one; and for a name of more than 60 bytes, which nobody mistypes.
[[nodiscard]] CONTREJOUR_API std::string nearest_name(std::string_view name,
                                                      const std::vector<std::string_view>& known);

}  // namespace contrejour
