// Text as other programs write it, brought to UTF-8 with '\n' line ends.
#pragma once

#include <string>
#include <string_view>

namespace contrejour {

// By byte order mark: UTF-8, UTF-16 of either order. Without: UTF-16 where every other byte of the beginning is 0,
// UTF-8 where it is that, else Latin-1. CR LF and CR become LF. A half surrogate becomes U+FFFD, an odd last byte is
// dropped. At most twice the bytes come out.
[[nodiscard]] std::string decode_text(std::string_view bytes);

[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace contrejour
