// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/json/json_fields.h"

#include <cmath>

#include <fmt/format.h>

#include "base/near_name.h"
#include "optics/lens_files/plain_number.h"

namespace contrejour::inline internal {
namespace {

std::string below(const std::string& path, std::string_view key) {
  return fmt::format("{}{}{}", path, path.empty() ? "" : ".", shortened(key));
}

}  // namespace

JsonField JsonField::operator[](std::string_view key) const {
  JsonField field = *this;
  field.node_ = is_map() ? node_->find(key) : nullptr;
  field.path_ = below(path_, key);
  if (field.node_ != nullptr) field.line_ = field.node_->line;
  return field;
}

JsonField JsonField::operator[](std::size_t index) const {
  JsonField field = *this;
  const bool there = (is_list() || is_map()) && index < node_->list.size();
  field.node_ = there ? &node_->list[index] : nullptr;
  if (there && is_map()) {
    field.path_ = below(path_, node_->keys[index]);
  } else {
    field.path_ += fmt::format("[{}]", index);
  }
  if (field.node_ != nullptr) field.line_ = field.node_->line;
  return field;
}

std::optional<double> JsonField::number() const {
  if (!is_there()) return std::nullopt;
  std::optional<double> value;
  if (node_->kind == JsonNode::Kind::Number) value = node_->number;
  if (node_->kind == JsonNode::Kind::Text) value = number_or_infinity(node_->text);
  if (!value || std::isnan(*value)) {
    fail("is no number");
    return std::nullopt;
  }
  if (std::abs(*value) > kLargestNumber) return *value > 0.0 ? kInfinity : -kInfinity;
  return *value + 0.0;  // -0 is 0
}

double JsonField::required_number() const {
  const auto value = number();
  if (!value || std::isinf(*value)) fail(is_there() ? "is not finite; give a number" : "is missing; give a number");
  return value.value_or(0.0);
}

std::string JsonField::text() const {
  if (!is_there()) return {};
  if (!is_text()) fail("is no text");
  return node_->text;
}

bool JsonField::truth() const {
  if (!is_there()) return false;
  if (is(JsonNode::Kind::Number)) return node_->number != 0.0;
  if (!is(JsonNode::Kind::Bool)) fail("is neither true nor false");
  return node_->truth;
}

void JsonField::fail(const std::string& message, ErrorCode code) const {
  errors_->fail(line_, path_.empty() ? message : fmt::format("{}: {}", path_, message), code);
}

}  // namespace contrejour::inline internal
