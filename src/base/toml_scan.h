// SPDX-License-Identifier: Apache-2.0
// Checks a text before toml++ parses it. toml++ bounds nested brackets but not keys: `a.a.a. ... = 1` makes nested
// tables, and destroying them recurses as deep as the key is long.
#pragma once

#include <string_view>

namespace contrejour::inline internal {

// The line of the first key of more than eight parts, counted from 1, or 0. A key of our format has at most two
// (glass.NAME); eight also admit other tables, so that these get the message about unknown keys.
[[nodiscard]] int line_of_deep_key(std::string_view text);

}  // namespace contrejour::inline internal
