// SPDX-License-Identifier: Apache-2.0
// Reads a YAML file into a tree, bounded in depth, nodes and size. yaml-cpp parses; its exceptions do not leave this
// file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct YamlNode {
  enum class Kind { Null, Scalar, List, Map };

  Kind kind = Kind::Null;
  int line = 0;  // from 1
  std::string scalar;
  std::vector<YamlNode> list;     // of a list, or a map's values
  std::vector<std::string> keys;  // of a map, as many

  // The map's value of that key; null if there is none or this is no map.
  [[nodiscard]] const YamlNode* find(std::string_view key) const;
};

inline constexpr std::size_t kYamlMaxBytes = std::size_t{1} << 20U;

// The file's first document. Errors: Parse with the line for invalid YAML, aliases, more than 1 MiB, 10000 nodes or ten
// levels.
[[nodiscard]] Result<YamlNode> parse_yaml(std::string_view text, const std::string& file);

}  // namespace contrejour::inline internal
