// SPDX-License-Identifier: Apache-2.0
#include "base/json_members.h"

#include <nlohmann/json.hpp>

#include "base/json_tree.h"

namespace contrejour::inline internal {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Text that is not UTF-8 keeps its readable part: nothing that a user typed can make writing fail.
std::string dumped(const OrderedJson& value, int indent = -1) {
  return value.dump(indent, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace

Result<std::vector<JsonMember>> json_members(std::string_view text, const std::string& file) {
  const auto bounded = parse_json(text, file);
  if (!bounded) return tl::unexpected(bounded.error());
  const OrderedJson whole = OrderedJson::parse(text, nullptr, false);
  if (!whole.is_object()) return failure(ErrorCode::Parse, "this is not a JSON object: it begins with {", {file, 1});
  std::vector<JsonMember> members;
  for (const auto& [key, value] : whole.items()) members.emplace_back(key, dumped(value));
  return members;
}

std::string json_of_members(std::span<const JsonMember> members) {
  OrderedJson whole = OrderedJson::object();
  for (const auto& [key, json] : members) {
    OrderedJson value = OrderedJson::parse(json, nullptr, false);
    if (!value.is_discarded()) whole[key] = std::move(value);
  }
  return dumped(whole, 2) + "\n";
}

std::string json_of_text(std::string_view text) { return dumped(OrderedJson(std::string(text))); }

std::string json_of_texts(std::span<const std::string> texts) {
  OrderedJson list = OrderedJson::array();
  for (const std::string& text : texts) list.push_back(text);
  return dumped(list);
}

}  // namespace contrejour::inline internal
