// A look at a text before toml++ parses it, which bounds nested brackets but not keys: `a.a.a. ... = 1` makes tables
// in tables, and destroying them takes a stack as deep as the key is long.
#pragma once

#include <string_view>

namespace contrejour {

// The line of the first key of more than eight parts, counted from 1, or 0. A key of our format has at most two
// (glass.NAME); eight leave room for other people's tables, so that those get the message about unknown keys.
[[nodiscard]] int line_of_deep_key(std::string_view text);

}  // namespace contrejour
