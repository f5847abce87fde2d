// SPDX-License-Identifier: Apache-2.0
// Words and titles of design programs' files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contrejour::inline internal {

// The words between blanks, at most `max_size` of them.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line, std::size_t max_size = 64);

// "/a/b/cooke.zmx" -> "cooke": for files that name no lens.
[[nodiscard]] std::string stem_of(const std::string& file);

// "70 mm", "f=70", "70": the nominal focal length in a position's title; 0 for other text.
[[nodiscard]] double nominal_focal_mm(std::string_view title);

// Truncates a long text, for the source of a lens, at a space.
[[nodiscard]] std::string cut_text(std::string text, std::size_t max_size = 200);

}  // namespace contrejour::inline internal
