// SPDX-License-Identifier: Apache-2.0
#include "base/yaml_tree.h"

#include <algorithm>
#include <exception>
#include <istream>
#include <stdexcept>
#include <streambuf>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxDepth = 10;
constexpr std::size_t kMaxNodes = 10000;

// Thrown through yaml-cpp, which knows no other way to stop, and caught below.
struct Stop : std::runtime_error {
  Stop(const YAML::Mark& mark, const std::string& what) : std::runtime_error(what), line(mark.line + 1) {}
  int line;
};

// Builds the tree; `open_` are the lists and maps that have begun.
class YamlTreeBuilder : public YAML::EventHandler {
 public:
  [[nodiscard]] YamlNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { position(mark, YamlNode::Kind::Null, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Stop(mark, "aliases are not read; write it out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t, const std::string& value) override {
    if (!open_.empty() && open_.back().node.kind == YamlNode::Kind::Map && !open_.back().has_key) {
      open_.back().key = value;
      open_.back().has_key = true;
      return;
    }
    position(mark, YamlNode::Kind::Scalar, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, YamlNode::Kind::List);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    open(mark, YamlNode::Kind::Map);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlNode node;
    std::string key;
    bool has_key = false;
  };

  void count(const YAML::Mark& mark) {
    if (++nodes_ > kMaxNodes) throw Stop(mark, fmt::format("more than {} values; no such file has so many", kMaxNodes));
  }
  void open(const YAML::Mark& mark, YamlNode::Kind kind) {
    count(mark);
    const bool as_key = !open_.empty() && open_.back().node.kind == YamlNode::Kind::Map && !open_.back().has_key;
    if (as_key) throw Stop(mark, "a key must be a word");
    if (open_.size() >= kMaxDepth) throw Stop(mark, fmt::format("nested deeper than {} levels", kMaxDepth));
    open_.emplace_back();
    open_.back().node.kind = kind;
    open_.back().node.line = mark.line + 1;
  }
  void close() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }
  void position(const YAML::Mark& mark, YamlNode::Kind kind, const std::string& value) {
    count(mark);
    const bool as_key = !open_.empty() && open_.back().node.kind == YamlNode::Kind::Map && !open_.back().has_key;
    if (as_key) throw Stop(mark, "a key is missing");
    YamlNode node;
    node.kind = kind;
    node.line = mark.line + 1;
    node.scalar = value;
    add(std::move(node));
  }
  void add(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
    } else if (open_.back().node.kind == YamlNode::Kind::List) {
      open_.back().node.list.push_back(std::move(node));
    } else {
      open_.back().node.keys.push_back(std::move(open_.back().key));
      open_.back().node.list.push_back(std::move(node));
      open_.back().has_key = false;
    }
  }

  YamlNode root_;
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
};

// Finds the line that opens too many brackets, or 0: yaml-cpp stores all open brackets, a quarter of a kilobyte each,
// before its first event. Brackets within words count too, but no ordinary text leaves as many open.
int line_of_many_brackets(std::string_view text) {
  constexpr int kMaxOpenBrackets = 1000;
  int line = 1, open = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++open;
    if (c == ']' || c == '}') open = std::max(open - 1, 0);
    if (open > kMaxOpenBrackets) return line;
    line += c == '\n' ? 1 : 0;
  }
  return 0;
}

// The text as a stream, without a copy.
class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // NOLINT: a get area is never written to
    setg(begin, begin, begin + text.size());
  }
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key) const {
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (keys[k] == key) return &list[k];
  return nullptr;
}

Result<YamlNode> parse_yaml(std::string_view text, const std::string& file) {
  if (text.size() > kYamlMaxBytes)
    return failure(ErrorCode::Parse, fmt::format("{} bytes; at most {} are read", text.size(), kYamlMaxBytes),
                   {file, 0, 0});
  if (const int line = line_of_many_brackets(text); line != 0)
    return failure(ErrorCode::Parse, fmt::format("nested deeper than {} levels", kMaxDepth), {file, line, 0});
  try {
    ViewBuffer buffer(text);
    std::istream stream(&buffer);
    YAML::Parser parser(stream);
    YamlTreeBuilder builder;
    parser.HandleNextDocument(builder);
    return builder.take();
  } catch (const Stop& stop) {
    return failure(ErrorCode::Parse, stop.what(), {file, stop.line, 0});
  } catch (const YAML::Exception& wrong) {
    const int line = wrong.mark.is_null() ? 0 : wrong.mark.line + 1;
    return failure(ErrorCode::Parse, fmt::format("not valid YAML: {}", wrong.msg), {file, line, 0});
  } catch (const std::exception& wrong) {
    return failure(ErrorCode::Parse, fmt::format("cannot be read as YAML: {}", wrong.what()), {file, 0, 0});
  }
}

}  // namespace contrejour::inline internal
