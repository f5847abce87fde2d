// SPDX-License-Identifier: Apache-2.0
// Cells of comma-separated tables. Thread-safety: pure functions.
#pragma once

#include <string>
#include <string_view>

namespace contrejour::cli {

// The text between quotation marks, its own ones doubled (RFC 4180), so that commas and line breaks may stand in it.
[[nodiscard]] inline std::string csv_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace contrejour::cli
