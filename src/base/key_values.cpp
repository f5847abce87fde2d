// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/key_values.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/near_name.h"
#include "base/text_file.h"
#include "base/toml_fields.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20U;

// A value that is not a list, or nothing.
bool read_scalar(const toml::node& node, KeyValue& to) {
  if (const auto* text = node.as_string()) {
    to.kind = KeyValue::Kind::Text;
    to.texts.push_back(text->get());
  } else if (const auto* whole = node.as_integer()) {
    to.kind = KeyValue::Kind::Number;
    to.texts.push_back(fmt::format("{}", whole->get()));
  } else if (const auto* real = node.as_floating_point(); real != nullptr && std::isfinite(real->get())) {
    to.kind = KeyValue::Kind::Number;
    to.texts.push_back(toml_number(real->get()));
  } else if (const auto* truth = node.as_boolean()) {
    to.kind = KeyValue::Kind::Boolean;
    to.texts.emplace_back(truth->get() ? "true" : "false");
  } else {
    return false;
  }
  return true;
}

bool read_list(const toml::array& list, KeyValue& to) {
  to.kind = KeyValue::Kind::TextList;
  for (const toml::node& item : list) {
    if (!item.is_string()) return false;
    to.texts.push_back(item.as_string()->get());
  }
  return true;
}

bool is_bare_key(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

}  // namespace

Result<std::vector<KeyValue>> read_key_values(std::string_view toml, const std::string& file, std::string_view page) {
  const auto table = parse_toml(toml, file, page);
  if (!table) return tl::unexpected(table.error());
  std::vector<KeyValue> all;
  for (const auto& [key, node] : *table) {
    const toml::source_position at = key.source().begin;
    KeyValue value{std::string(key.str()), {}, {}, {file, static_cast<int>(at.line), static_cast<int>(at.column)}};
    const bool read = node.is_array() ? read_list(*node.as_array(), value) : read_scalar(node, value);
    if (!read) {
      return failure(ErrorCode::Parse,
                     fmt::format("{} is neither text in quotes nor a finite number, true, false or a list of texts; "
                                 "see {}",
                                 shortened(value.key), page),
                     value.position);
    }
    all.push_back(std::move(value));
  }
  std::sort(all.begin(), all.end(), [](const KeyValue& a, const KeyValue& b) {
    return std::pair(a.position.line, a.position.column) < std::pair(b.position.line, b.position.column);
  });
  return all;
}

Result<std::vector<KeyValue>> read_key_values(const std::filesystem::path& file, std::string_view page) {
  const auto text = read_text_file(file, kMaxFileBytes, fmt::format("see {}", page));
  if (!text) return tl::unexpected(text.error());
  return read_key_values(*text, file.string(), page);
}

std::string write_key_values(std::span<const KeyValue> values) {
  std::string out;
  for (const KeyValue& value : values) {
    std::vector<std::string> texts = value.texts;
    const bool quoted = value.kind == KeyValue::Kind::Text || value.kind == KeyValue::Kind::TextList;
    for (std::string& text : texts) {
      if (quoted) text = toml_string(text);
    }
    const std::string joined = fmt::format("{}", fmt::join(texts, ", "));
    out += fmt::format("{} = {}\n", is_bare_key(value.key) ? value.key : toml_string(value.key),
                       value.kind == KeyValue::Kind::TextList ? fmt::format("[{}]", joined) : joined);
  }
  return out;
}

}  // namespace contrejour
