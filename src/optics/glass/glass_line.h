// SPDX-License-Identifier: Apache-2.0
// The bundled catalogue's own files, data/glasses: one line a glass. docs/formats/glass.md.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/glass_catalogue.h"

namespace contrejour::inline internal {

struct BundledGlassFile {
  std::string_view name;  // "schott"
  std::string_view text;
};
[[nodiscard]] std::vector<BundledGlassFile> bundled_glass_files();
[[nodiscard]] std::string maker_of_bundled(std::string_view file_name);  // "SCHOTT"

// NAME; STATUS; CODE; N_D V_D; FORMULA C ...; FIRST LAST (nm); T_REF [D0 D1 D2 E0 E1 L_TK]; NM PER_M ...
// These lines are the library's own and tested, not a user's: an error in one gives a glass of index NaN.
[[nodiscard]] GlassSummary summary_of_line(std::string_view line, const std::string& maker);
[[nodiscard]] CatalogueEntry entry_of_line(std::string_view line, const std::string& maker);

// Visits lines that are neither empty nor comments (#).
template <class Visit>
void for_each_glass_line(std::string_view text, Visit visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (end > 0 && text.front() != '#') visit(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace contrejour::inline internal
