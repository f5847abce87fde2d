// Words and titles of design programs' files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace contrejour {

// Between blanks; no more than `most` of them.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line, std::size_t most = 64);

// "/a/b/cooke.zmx" -> "cooke": for files that name no lens.
[[nodiscard]] std::string stem_of(const std::string& file);

// "70 mm", "f=70", "70": the focal length that a position is called by; 0 for all else.
[[nodiscard]] double nominal_focal_mm(std::string_view title);

// A long text cut to what a lens's source is to be, at a space.
[[nodiscard]] std::string cut_text(std::string text, std::size_t most = 200);

}  // namespace contrejour
