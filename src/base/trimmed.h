// SPDX-License-Identifier: Apache-2.0
// Removes the spaces at both ends of a text.
#pragma once

#include <string_view>

namespace contrejour::inline internal {

[[nodiscard]] inline std::string_view trimmed(std::string_view text, std::string_view spaces = " \t\r") {
  const std::size_t first = text.find_first_not_of(spaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(spaces) - first + 1);
}

}  // namespace contrejour::inline internal
