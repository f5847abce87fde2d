// SPDX-License-Identifier: Apache-2.0
// A flat TOML file: names and values that the caller interprets, such as a preset (docs/formats/preset.md).
// Text, numbers, true and false, and lists of text; no tables. Bounded in memory and time. Errors name file and line.
// Thread-safety: pure functions.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct KeyValue {
  enum class Kind { Text, Number, Boolean, TextList };

  std::string key;
  Kind kind = Kind::Text;
  std::vector<std::string> texts;  // one, or a list's; a number as short as it reads back, "true" or "false"
  SourcePosition position = {};          // in the file it was read from
};

// In the file's order. page: the document that shows such a file, for errors.
[[nodiscard]] CONTREJOUR_API Result<std::vector<KeyValue>> read_key_values(std::string_view toml,
                                                                           const std::string& file,
                                                                           std::string_view page);
[[nodiscard]] CONTREJOUR_API Result<std::vector<KeyValue>> read_key_values(const std::filesystem::path& file,
                                                                           std::string_view page);

// One line each, in the order given; reads back as the same.
[[nodiscard]] CONTREJOUR_API std::string write_key_values(std::span<const KeyValue> values);

}  // namespace contrejour
