// Text that is safe on a terminal: names in files and on the command line may hold anything.
#pragma once

#include <string>
#include <string_view>

namespace contrejour::cli {

enum class Lines { Keep, Join };  // Keep leaves line ends and tabs as they are

// Control characters (C0, DEL, C1), those that turn the direction of writing, and bytes that are not UTF-8 become '?'.
[[nodiscard]] std::string printable(std::string_view text, Lines lines);

// The same characters of JSON text as \u escapes, which stand for them; it is UTF-8 already.
[[nodiscard]] std::string printable_json(std::string_view json);

}  // namespace contrejour::cli
