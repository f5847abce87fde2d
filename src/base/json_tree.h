// SPDX-License-Identifier: Apache-2.0
// Reads a JSON file into a tree with the line of each value, bounded in depth, values and size. nlohmann-json parses;
// its exceptions do not leave this file. Python's NaN, Infinity and -Infinity are read as numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct JsonNode {
  enum class Kind : std::uint8_t { Null, Bool, Number, Text, List, Map };

  Kind kind = Kind::Null;
  bool truth = false;
  int line = 0;  // from 1: the line where a value ends, or a list or map begins
  double number = 0.0;
  std::string text = {};
  std::vector<JsonNode> list = {};     // of a list, or a map's values
  std::vector<std::string> keys = {};  // of a map, as many

  // The map's value of that key, the last of several; null if there is none or this is no map.
  [[nodiscard]] const JsonNode* find(std::string_view key) const;
};

inline constexpr std::size_t kJsonMaxBytes = std::size_t{1} << 20U;
inline constexpr std::size_t kJsonMaxValues = 200'000;
inline constexpr std::size_t kJsonMaxDepth = 64;

// Errors: Parse with the line for invalid JSON, and for more bytes, values or levels than those limits.
[[nodiscard]] Result<JsonNode> parse_json(std::string_view text, const std::string& file);

}  // namespace contrejour::inline internal
