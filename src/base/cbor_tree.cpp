// SPDX-License-Identifier: Apache-2.0
#include "base/cbor_tree.h"

#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace contrejour::inline internal {
namespace {

using Cbor = nlohmann::ordered_json;

// Builds the tree from nlohmann's events; returning false stops its parser.
class CborTreeBuilder {
 public:
  CborTreeBuilder() { open_.push_back(cbor_list()); }

  bool null() { return fail("an empty value"); }
  bool boolean(bool /*value*/) { return fail("a logical value"); }
  bool number_integer(Cbor::number_integer_t value) { return add(cbor_number(static_cast<double>(value))); }
  bool number_unsigned(Cbor::number_unsigned_t value) { return add(cbor_number(static_cast<double>(value))); }
  bool number_float(Cbor::number_float_t value, const Cbor::string_t& /*as_written*/) {
    return add(cbor_number(value));
  }
  bool string(Cbor::string_t& value) { return add(cbor_text(std::move(value))); }
  bool binary(Cbor::binary_t& value) { return add(cbor_bytes(std::string(value.begin(), value.end()))); }
  bool key(Cbor::string_t& value) {
    open_.back().keys.push_back(std::move(value));
    return true;
  }
  bool start_object(std::size_t /*count*/) { return open({}); }
  bool start_array(std::size_t /*count*/) { return open(cbor_list()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t position, const std::string& /*token*/, const Cbor::exception& /*wrong*/) {
    return fail(fmt::format("invalid CBOR at byte {}", position));
  }

  [[nodiscard]] const std::optional<std::string>& error() const { return error_; }
  [[nodiscard]] CborNode take() { return std::move(open_.front().list.front()); }

 private:
  bool fail(std::string message) {
    if (!error_) error_ = std::move(message);
    return false;
  }
  bool add(CborNode node) {
    if (++values_ > kCborMaxValues) return fail(fmt::format("more than {} values", kCborMaxValues));
    open_.back().list.push_back(std::move(node));
    return true;
  }
  bool open(CborNode node) {
    if (open_.size() > kCborMaxDepth) return fail(fmt::format("nested deeper than {} levels", kCborMaxDepth));
    open_.push_back(std::move(node));
    return true;
  }
  bool close() {
    CborNode done = std::move(open_.back());
    open_.pop_back();
    return add(std::move(done));
  }

  std::vector<CborNode> open_;
  std::optional<std::string> error_;
  std::size_t values_ = 0;
};

Cbor cbor_of(const CborNode& node) {
  constexpr double kExact = 9e15;  // whole numbers up to here are exact in double
  switch (node.kind) {
    case CborNode::Kind::Number:
      if (node.number == std::floor(node.number) && std::abs(node.number) < kExact)
        return static_cast<std::int64_t>(node.number);
      return node.number;
    case CborNode::Kind::Text: return node.text;
    case CborNode::Kind::Bytes: return Cbor::binary({node.text.begin(), node.text.end()});
    case CborNode::Kind::List: {
      Cbor list = Cbor::array();
      for (const CborNode& value : node.list) list.push_back(cbor_of(value));
      return list;
    }
    case CborNode::Kind::Map: break;
  }
  Cbor map = Cbor::object();
  for (std::size_t k = 0; k < node.keys.size(); ++k) map[node.keys[k]] = cbor_of(node.list[k]);
  return map;
}

}  // namespace

const CborNode* CborNode::find(std::string_view key) const {
  if (kind != Kind::Map) return nullptr;
  for (std::size_t k = keys.size(); k-- > 0;)
    if (keys[k] == key) return &list[k];
  return nullptr;
}

void CborNode::add(std::string key, CborNode value) {
  keys.push_back(std::move(key));
  list.push_back(std::move(value));
}

CborNode cbor_number(double value) { return {.kind = CborNode::Kind::Number, .number = value}; }
CborNode cbor_text(std::string value) { return {.kind = CborNode::Kind::Text, .text = std::move(value)}; }
CborNode cbor_bytes(std::string value) { return {.kind = CborNode::Kind::Bytes, .text = std::move(value)}; }
CborNode cbor_list(std::vector<CborNode> values) { return {.kind = CborNode::Kind::List, .list = std::move(values)}; }

std::string write_cbor(const CborNode& root) {
  const auto bytes = Cbor::to_cbor(cbor_of(root));
  return {bytes.begin(), bytes.end()};
}

Result<CborNode> parse_cbor(std::string_view bytes, const std::string& file) {
  CborTreeBuilder builder;
  bool whole = false;
  try {
    whole = Cbor::sax_parse(bytes.begin(), bytes.end(), &builder, nlohmann::detail::input_format_t::cbor);
  } catch (const std::exception& wrong) {
    return failure(ErrorCode::Parse, fmt::format("cannot be read as CBOR: {}", wrong.what()), {file, 0, 0});
  }
  if (!whole || builder.error())
    return failure(ErrorCode::Parse, builder.error().value_or("not valid CBOR"), {file, 0, 0});
  return builder.take();
}

}  // namespace contrejour::inline internal
