// SPDX-License-Identifier: Apache-2.0
// A value of a JSON file and its path, for readers of lens files: a missing value or one of another kind is reported
// once, with its line and path ("surfaces[3].radius").
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/json_tree.h"
#include "contrejour/result.h"
#include "optics/lens_files/first_error.h"

namespace contrejour::inline internal {

using JsonErrors = FirstError;

// Cheap to copy; the tree and the errors must outlive it.
class JsonField {
 public:
  JsonField(const JsonNode& root, JsonErrors& errors) : node_(&root), errors_(&errors), line_(root.line) {}

  // The same value, with its errors reported there.
  [[nodiscard]] JsonField reporting_to(JsonErrors& errors) const {
    JsonField field = *this;
    field.errors_ = &errors;
    return field;
  }

  // A map's or list's value; an absent field if there is none.
  [[nodiscard]] JsonField operator[](std::string_view key) const;
  [[nodiscard]] JsonField operator[](std::size_t index) const;

  [[nodiscard]] bool is_there() const { return node_ != nullptr && node_->kind != JsonNode::Kind::Null; }
  [[nodiscard]] bool is(JsonNode::Kind kind) const { return node_ != nullptr && node_->kind == kind; }
  [[nodiscard]] bool is_map() const { return is(JsonNode::Kind::Map); }
  [[nodiscard]] bool is_list() const { return is(JsonNode::Kind::List); }
  [[nodiscard]] bool is_text() const { return is(JsonNode::Kind::Text); }
  [[nodiscard]] std::size_t size() const { return node_ == nullptr ? 0 : node_->list.size(); }
  [[nodiscard]] std::string_view key(std::size_t index) const { return node_->keys[index]; }
  [[nodiscard]] int line() const { return line_; }  // its own, or that of the nearest enclosing value
  [[nodiscard]] const std::string& path() const { return path_; }

  // A number, also within quotes ("Infinity", "inf" too); none for null and absent values, an error for all others.
  // Numbers beyond kLargestNumber are infinite.
  [[nodiscard]] std::optional<double> number() const;
  [[nodiscard]] double number_or(double fallback) const { return number().value_or(fallback); }
  // As number(), but absent values and infinities are errors.
  [[nodiscard]] double required_number() const;
  // A text; empty for null and absent values, an error for all others.
  [[nodiscard]] std::string text() const;
  // A truth value; false for null and absent values, a number is true unless 0; an error for all others.
  [[nodiscard]] bool truth() const;

  // "surfaces[3].radius: what is wrong".
  void fail(const std::string& message, ErrorCode code = ErrorCode::Parse) const;
  [[nodiscard]] bool failed() const { return errors_->first.has_value(); }

 private:
  const JsonNode* node_;
  JsonErrors* errors_;
  int line_;
  std::string path_;
};

}  // namespace contrejour::inline internal
