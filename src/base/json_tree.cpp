// SPDX-License-Identifier: Apache-2.0
#include "base/json_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace contrejour::inline internal {
namespace {

using nlohmann::json;

struct TextPosition {
  int line = 1;
  bool after_line_end = false;  // the character read last ended a line
  // A value is complete only after the character behind it was read, which may have ended its line.
  [[nodiscard]] int of_value() const { return after_line_end ? line - 1 : line; }
};

// The text's characters; counts lines as they are read.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, TextPosition* position) : at_(at), position_(position) {}
  const char& operator*() const { return *at_; }
  CountingIterator& operator++() {
    position_->after_line_end = *at_ == '\n';
    if (position_->after_line_end) ++position_->line;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }
  friend bool operator!=(const CountingIterator& a, const CountingIterator& b) { return a.at_ != b.at_; }

 private:
  const char* at_;
  TextPosition* position_;
};

// Builds the tree from nlohmann's events; returning false stops its parser.
class JsonTreeBuilder {
 public:
  explicit JsonTreeBuilder(const TextPosition& position) : position_(position) { open_.push_back({}); }

  bool null() { return add({}); }
  bool boolean(bool value) { return add({.kind = JsonNode::Kind::Bool, .truth = value}); }
  bool number_integer(json::number_integer_t value) { return number(static_cast<double>(value)); }
  bool number_unsigned(json::number_unsigned_t value) { return number(static_cast<double>(value)); }
  bool number_float(json::number_float_t value, const json::string_t& /*as_written*/) { return number(value); }
  bool string(json::string_t& value) { return add({.kind = JsonNode::Kind::Text, .text = std::move(value)}); }
  bool binary(json::binary_t& /*value*/) { return fail("binary values are not read"); }
  bool key(json::string_t& value) {
    open_.back().keys.push_back(std::move(value));
    return true;
  }
  bool start_object(std::size_t /*count*/) { return open(JsonNode::Kind::Map); }
  bool start_array(std::size_t /*count*/) { return open(JsonNode::Kind::List); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t /*position*/, const std::string& /*token*/, const json::exception& wrong) {
    // Keeps the part behind the prefix "[json.exception.parse_error.101] parse error at line 1, column 2: ".
    const std::string_view all = wrong.what();
    const std::size_t colon = all.find(": ");
    return fail(fmt::format("not valid JSON: {}", all.substr(colon == std::string_view::npos ? 0 : colon + 2)));
  }

  [[nodiscard]] std::optional<std::string> error() const { return error_; }
  [[nodiscard]] JsonNode take() { return std::move(open_.front().list.front()); }

 private:
  bool fail(std::string message) {
    if (!error_) error_ = std::move(message);
    return false;
  }
  bool number(double value) { return add({.kind = JsonNode::Kind::Number, .number = value}); }
  bool add(JsonNode node) {
    if (++values_ > kJsonMaxValues) return fail(fmt::format("more than {} values", kJsonMaxValues));
    if (node.line == 0) node.line = position_.of_value();
    open_.back().list.push_back(std::move(node));
    return true;
  }
  bool open(JsonNode::Kind kind) {
    if (open_.size() > kJsonMaxDepth) return fail(fmt::format("nested deeper than {} levels", kJsonMaxDepth));
    open_.push_back({.kind = kind, .line = position_.of_value()});
    return true;
  }
  bool close() {
    JsonNode node = std::move(open_.back());
    open_.pop_back();
    return add(std::move(node));
  }

  const TextPosition& position_;
  std::vector<JsonNode> open_;
  std::size_t values_ = 0;
  std::optional<std::string> error_;
};

// Python's words for numbers that JSON lacks are replaced, outside quotes, by numbers that occur in no file.
constexpr std::string_view kInfinity = "1.25e308", kMinusInfinity = "-1.25e308", kNan = "-1.5e308";

std::string without_pythons_words(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kWords[] = {
      {"-Infinity", kMinusInfinity}, {"Infinity", kInfinity}, {"NaN", kNan}};
  std::string out;
  out.reserve(text.size() + 64);
  // Jumps from one relevant character to the next: a quote, or outside quotes the first letter of a word.
  bool quoted = false;
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t at = std::min(text.find_first_of(quoted ? "\"\\" : "\"-IN", k), text.size());
    out += text.substr(k, at - k);
    k = at;
    if (k == text.size()) break;
    const std::string_view rest = text.substr(k);
    const auto word = std::find_if(std::begin(kWords), std::end(kWords),
                                   [&](const auto& w) { return !quoted && rest.starts_with(w.first); });
    if (word != std::end(kWords)) {
      out += word->second;
      k += word->first.size();
      continue;
    }
    if (rest.front() == '"') quoted = !quoted;
    const std::size_t taken = rest.front() == '\\' ? std::min<std::size_t>(2, rest.size()) : 1;
    out += rest.substr(0, taken);
    k += taken;
  }
  return out;
}

void restore_pythons_words(JsonNode& node) {
  if (node.number == 1.25e308) node.number = std::numeric_limits<double>::infinity();
  if (node.number == -1.25e308) node.number = -std::numeric_limits<double>::infinity();
  if (node.number == -1.5e308) node.number = std::numeric_limits<double>::quiet_NaN();
  for (JsonNode& child : node.list) restore_pythons_words(child);
}

}  // namespace

const JsonNode* JsonNode::find(std::string_view key) const {
  for (std::size_t k = keys.size(); k-- > 0;)
    if (keys[k] == key) return &list[k];
  return nullptr;
}

Result<JsonNode> parse_json(std::string_view text, const std::string& file) {
  if (text.size() > kJsonMaxBytes)
    return failure(ErrorCode::Parse, fmt::format("{} bytes; at most {} are read", text.size(), kJsonMaxBytes),
                   {file, 0, 0});
  const std::string plain = without_pythons_words(text);
  TextPosition position;
  JsonTreeBuilder builder(position);
  const char* begin = plain.data();
  const char* end = begin + plain.size();
  bool whole = false;
  try {
    whole = json::sax_parse(CountingIterator(begin, &position), CountingIterator(end, &position), &builder);
  } catch (const std::exception& wrong) {
    return failure(ErrorCode::Parse, fmt::format("cannot be read as JSON: {}", wrong.what()), {file, 0, 0});
  }
  if (!whole)
    return failure(ErrorCode::Parse, builder.error().value_or("not valid JSON"), {file, position.of_value(), 0});
  JsonNode root = builder.take();
  restore_pythons_words(root);
  return root;
}

}  // namespace contrejour::inline internal
