// SPDX-License-Identifier: Apache-2.0
// Converts text of other programs to UTF-8 with '\n' line ends.
#pragma once

#include <string>
#include <string_view>

namespace contrejour::inline internal {

// A byte order mark selects UTF-8 or UTF-16 of either order. Without a mark the text is UTF-16 if every other byte of
// its beginning is 0, UTF-8 if it is valid UTF-8, else Latin-1. CR LF and CR become LF. A half surrogate becomes
// U+FFFD, an odd last byte is dropped. The result has at most twice as many bytes.
[[nodiscard]] std::string decode_text(std::string_view bytes);

[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace contrejour::inline internal
