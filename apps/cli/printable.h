// SPDX-License-Identifier: Apache-2.0
// Makes text safe to print on a terminal: names in files and on the command line may contain any bytes.
#pragma once

#include <string>
#include <string_view>

namespace contrejour::cli {

enum class Lines { Keep, Join };  // Keep preserves line ends and tabs

// Replaces control characters (C0, DEL, C1), bidirectional controls, and bytes that are not UTF-8 by '?'.
[[nodiscard]] std::string printable(std::string_view text, Lines lines);

// Replaces the same characters in JSON text by equivalent \u escapes; JSON text is UTF-8 already.
[[nodiscard]] std::string printable_json(std::string_view json);

}  // namespace contrejour::cli
