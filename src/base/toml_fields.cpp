// SPDX-License-Identifier: Apache-2.0
#include "base/toml_fields.h"

#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/toml_scan.h"

namespace contrejour::inline internal {

namespace {

// A TOML type in a user's words.
std::string_view type_name(toml::node_type type) {
  switch (type) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "text";
    case toml::node_type::integer: return "a whole number";
    case toml::node_type::floating_point: return "a number";
    case toml::node_type::boolean: return "true or false";
    case toml::node_type::date:
    case toml::node_type::time:
    case toml::node_type::date_time: return "a date or time";
    default: return "nothing";
  }
}

}  // namespace

void TomlErrors::fail(const toml::source_region& where, std::string message) {
  if (error_) return;
  error_ = Error{ErrorCode::Parse, std::move(message),
                 SourcePosition{file_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column)}};
}

TomlFields::TomlFields(const toml::table& table, std::string what, std::initializer_list<std::string_view> known,
                       TomlErrors& errors)
    : table_(table), what_(std::move(what)), errors_(errors) {
  refuse_unknown_keys(known);
}

void TomlFields::refuse_unknown_keys(std::initializer_list<std::string_view> known) {
  for (const auto& [key, node] : table_) {
    bool is_known = false;
    for (const std::string_view name : known) is_known = is_known || name == key.str();
    if (is_known) continue;
    const std::string near = nearest_name(key.str(), {known.begin(), known.end()});
    std::string remedy;
    if (!near.empty()) {
      remedy = fmt::format("did you mean '{}'?", near);
    } else {
      remedy = fmt::format("known are {}", fmt::join(known, ", "));
    }
    errors_.fail(key.source(), fmt::format("{}: unknown key '{}'; {}", what_, shortened(key.str()), remedy));
    return;
  }
}

void TomlFields::fail(const toml::node& where, std::string_view message) {
  errors_.fail(where, fmt::format("{}: {}", what_, message));
}

void TomlFields::fail_type(const toml::node& node, std::string_view key, std::string_view wanted) {
  fail(node, fmt::format("{} must be {}, not {}", key, wanted, type_name(node.type())));
}

std::string TomlFields::required_text(std::string_view key, std::string_view remedy) {
  if (!has(key)) fail_here(fmt::format("{} is missing; {}", key, remedy));
  const std::string value = text(key).value_or("");
  if (has(key) && value.empty()) fail(*find(key), fmt::format("{} is empty; {}", key, remedy));
  return value;
}

double TomlFields::required_number(std::string_view key, NumberRange range, std::string_view remedy) {
  if (!has(key)) fail_here(fmt::format("{} is missing; {}", key, remedy));
  return number(key, range).value_or(range.low);
}

std::optional<std::string> TomlFields::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_string();
  if (value == nullptr) {
    fail_type(*node, key, "text in quotes");
    return std::nullopt;
  }
  return value->get();
}

std::optional<double> TomlFields::number(std::string_view key, NumberRange range) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  return number_at(*node, key, range);
}

double TomlFields::number_at(const toml::node& node, std::string_view name, NumberRange range) {
  if (!node.is_number()) {
    fail_type(node, name, "a number");
    return range.low;
  }
  // node.value<double>() would refuse whole numbers that a double cannot represent exactly.
  const double value =
      node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  // Written so that NaN fails too.
  if (!(value >= range.low && value <= range.high)) {
    fail(node, fmt::format("{} is {}; give a number from {} to {}", name, value, range.low, range.high));
    return range.low;
  }
  return value;
}

std::optional<bool> TomlFields::boolean(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* value = node->as_boolean();
  if (value == nullptr) {
    fail_type(*node, key, "true or false");
    return std::nullopt;
  }
  return value->get();
}

const toml::table* TomlFields::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) fail_type(*node, key, "a table");
  return node == nullptr ? nullptr : node->as_table();
}

const toml::array* TomlFields::array(std::string_view key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_array()) fail_type(*node, key, "a list in brackets");
  return node == nullptr ? nullptr : node->as_array();
}

Result<toml::table> parse_toml(std::string_view text, const std::string& file, std::string_view page) {
  if (const int line = line_of_deep_key(text); line > 0) {
    return failure(ErrorCode::Parse,
                   fmt::format("a key has too many parts; no file of ours has more than two; see {}", page),
                   {file, line, 0});
  }
  toml::parse_result parsed = toml::parse(text, std::string_view(file));
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    return failure(ErrorCode::Parse,
                   fmt::format("not valid TOML: {}; {} shows a complete file", error.description(), page),
                   {file, static_cast<int>(error.source().begin.line), static_cast<int>(error.source().begin.column)});
  }
  return std::move(parsed).table();
}

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      out += fmt::format("\\u{:04X}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string toml_number(double value) { return fmt::format("{}", value + 0.0); }

}  // namespace contrejour::inline internal
