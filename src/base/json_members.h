// SPDX-License-Identifier: Apache-2.0
// A JSON object as the texts of its members, which a program can keep without knowing what they mean. Bounded as
// json_tree.h is. Thread-safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::inline internal {

using JsonMember = std::pair<std::string, std::string>;  // key and JSON text

// In the file's order. Errors: those of parse_json; Parse for a text that is no object.
[[nodiscard]] Result<std::vector<JsonMember>> json_members(std::string_view text, const std::string& file);

// One object of these members, in their order and indented. A member that is not valid JSON is left out.
[[nodiscard]] std::string json_of_members(std::span<const JsonMember> members);

[[nodiscard]] std::string json_of_text(std::string_view text);
[[nodiscard]] std::string json_of_texts(std::span<const std::string> texts);

}  // namespace contrejour::inline internal
