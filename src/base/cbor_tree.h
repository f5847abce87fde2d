// SPDX-License-Identifier: Apache-2.0
// Reads and writes CBOR (RFC 8949) as a tree, bounded in depth, values and size. nlohmann-json reads and writes the
// bytes; its exceptions do not leave this file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/result.h"

namespace contrejour::inline internal {

struct CborNode {
  enum class Kind : std::uint8_t { Number, Text, Bytes, List, Map };

  Kind kind = Kind::Map;
  double number = 0.0;
  std::string text = {};  // of a text, or of bytes
  std::vector<CborNode> list = {};     // of a list, or a map's values
  std::vector<std::string> keys = {};  // of a map, as many

  // The map's value of that key, the last of several; null if there is none or this is no map.
  [[nodiscard]] const CborNode* find(std::string_view key) const;
  void add(std::string key, CborNode value);
};
[[nodiscard]] CborNode cbor_number(double value);
[[nodiscard]] CborNode cbor_text(std::string value);
[[nodiscard]] CborNode cbor_bytes(std::string value);
[[nodiscard]] CborNode cbor_list(std::vector<CborNode> values = {});

inline constexpr std::size_t kCborMaxValues = 500'000;
inline constexpr std::size_t kCborMaxDepth = 16;

// Whole numbers are written as such; others as double.
[[nodiscard]] std::string write_cbor(const CborNode& root);
// Errors: Parse for invalid CBOR, for kinds of values that a node does not have, and for more values or levels than
// those limits.
[[nodiscard]] Result<CborNode> parse_cbor(std::string_view bytes, const std::string& file);

}  // namespace contrejour::inline internal
