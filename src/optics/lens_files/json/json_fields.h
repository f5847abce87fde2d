// A value of a JSON file and the way to it, for readers of lens files: what is missing or of another kind is said once,
// with its line and its path ("surfaces[3].radius").
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/json_tree.h"
#include "contrejour/result.h"
#include "optics/lens_files/first_error.h"

namespace contrejour {

using JsonErrors = FirstError;

// Cheap to copy; the tree and the errors must outlive it.
class JsonField {
 public:
  JsonField(const JsonNode& root, JsonErrors& errors) : node_(&root), errors_(&errors), line_(root.line) {}

  // The same value, its errors noted there.
  [[nodiscard]] JsonField reporting_to(JsonErrors& errors) const {
    JsonField field = *this;
    field.errors_ = &errors;
    return field;
  }

  // A map's value or a list's; of what is not there, one that is not there.
  [[nodiscard]] JsonField operator[](std::string_view key) const;
  [[nodiscard]] JsonField operator[](std::size_t index) const;

  [[nodiscard]] bool is_there() const { return node_ != nullptr && node_->kind != JsonNode::Kind::Null; }
  [[nodiscard]] bool is(JsonNode::Kind kind) const { return node_ != nullptr && node_->kind == kind; }
  [[nodiscard]] bool is_map() const { return is(JsonNode::Kind::Map); }
  [[nodiscard]] bool is_list() const { return is(JsonNode::Kind::List); }
  [[nodiscard]] bool is_text() const { return is(JsonNode::Kind::Text); }
  [[nodiscard]] std::size_t size() const { return node_ == nullptr ? 0 : node_->list.size(); }
  [[nodiscard]] std::string_view key(std::size_t index) const { return node_->keys[index]; }
  [[nodiscard]] int line() const { return line_; }  // its own, or that of the nearest around it
  [[nodiscard]] const std::string& path() const { return path_; }

  // A number, or one within quotes ("Infinity", "inf" too); none for null and what is absent, an error for all else.
  // At most kLargestNumber, or infinite; a number beyond is infinite.
  [[nodiscard]] std::optional<double> number() const;
  [[nodiscard]] double number_or(double fallback) const { return number().value_or(fallback); }
  // An error for what is absent, too, and for infinities.
  [[nodiscard]] double required_number() const;
  // Empty for null and what is absent, an error for what is no text.
  [[nodiscard]] std::string text() const;
  // false for null and what is absent; a number is true unless 0; an error for all else.
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

}  // namespace contrejour
