// SPDX-License-Identifier: Apache-2.0
#include "base/yaml_tree.h"

#include <doctest/doctest.h>

#include "base/repeated.h"

namespace contrejour {
namespace {

void check_yaml_refused(const std::string& text, const std::string& words, int line = 0) {
  CAPTURE(text.substr(0, 80));
  const auto tree = parse_yaml(text, "x.yml");
  REQUIRE_FALSE(tree.has_value());
  CAPTURE(tree.error().message);
  CHECK(tree.error().message.find(words) != std::string::npos);
  CHECK(tree.error().position.file == "x.yml");
  if (line != 0) CHECK(tree.error().position.line == line);
}

TEST_CASE("a tree with lines") {
  const auto tree =
      parse_yaml("# head\nA:\n  - type: x\n    text: |\n      1 2\n      3 4\n  - [p, 'q r']\nB: 5\nC:\n", "x.yml");
  REQUIRE(tree.has_value());
  const YamlNode* a = tree->find("A");
  REQUIRE(a != nullptr);
  REQUIRE(a->list.size() == 2);
  CHECK(a->list[0].find("text")->scalar == "1 2\n3 4\n");
  CHECK(a->list[0].line == 3);
  CHECK(a->list[1].list[1].scalar == "q r");
  CHECK(tree->find("B")->scalar == "5");
  CHECK(tree->find("C")->kind == YamlNode::Kind::Null);
  CHECK(tree->find("D") == nullptr);
  CHECK(parse_yaml("", "x.yml").has_value());
}

TEST_CASE("what is refused, and where") {
  check_yaml_refused("a: 1\nb: [1, 2\n", "not valid YAML");
  check_yaml_refused("a: 1\n\tb: 2\n", "not valid YAML");
  check_yaml_refused("a: &x 1\nb: *x\n", "aliases", 2);
  check_yaml_refused("a: 1\n? [b]\n: 2\n", "key must be a word");
  check_yaml_refused("a: 1\n? \n: 2\n", "key");
  check_yaml_refused(repeated("[", 100'000), "nested deeper", 1);
  check_yaml_refused("a: 1\nb: " + repeated("{a: ", 100'000), "nested deeper", 2);
  check_yaml_refused(repeated("[\n", 100'000), "nested deeper");
  check_yaml_refused("a: " + repeated("[", 20) + repeated("]", 20), "nested deeper");
  check_yaml_refused(repeated("- ", 100'000), "nested deeper");
  check_yaml_refused("a:\n" + repeated("  - 1\n", 20'000), "more than 10000 values", 10000);
  check_yaml_refused(std::string(2U << 20U, ' '), "at most");
}

}  // namespace
}  // namespace contrejour
