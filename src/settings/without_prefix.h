// SPDX-License-Identifier: Apache-2.0
// Removes the prefix of a parameter's text, as in "list:2-5". Thread-safety: a pure function.
#pragma once

#include <optional>
#include <string_view>

namespace contrejour::params {

// The text after this prefix; nullopt if it begins otherwise.
[[nodiscard]] inline std::optional<std::string_view> without_prefix(std::string_view text, std::string_view prefix) {
  if (!text.starts_with(prefix)) return std::nullopt;
  return text.substr(prefix.size());
}

}  // namespace contrejour::params
