// SPDX-License-Identifier: Apache-2.0
#include "base/json_tree.h"

#include <cmath>

#include <doctest/doctest.h>

#include "base/repeated.h"

namespace contrejour {
namespace {

void check_json_refused(const std::string& text, const std::string& words, int line) {
  CAPTURE(text.substr(0, 80));
  const auto tree = parse_json(text, "x.json");
  REQUIRE_FALSE(tree.has_value());
  CAPTURE(tree.error().message);
  CHECK(tree.error().message.find(words) != std::string::npos);
  CHECK(tree.error().message.size() < 500);
  CHECK(tree.error().position.file == "x.json");
  CHECK(tree.error().position.line == line);
}

TEST_CASE("a JSON tree with the line of each value") {
  const auto tree = parse_json(
      "{\n \"a\": [1,\n -2.5e1\n , \"two\\n\\\"NaN\"],\n\"b\": {\"c\": null,\n\"d\": true}, \"a\": 7\n}", "x.json");
  REQUIRE(tree.has_value());
  REQUIRE(tree->keys.size() == 3);
  const JsonNode& list = tree->list[0];
  REQUIRE(list.list.size() == 3);
  CHECK(list.line == 2);
  CHECK(list.list[0].number == 1.0);
  CHECK(list.list[0].line == 2);
  CHECK(list.list[1].number == -25.0);
  CHECK(list.list[1].line == 3);
  CHECK(list.list[2].text == "two\n\"NaN");
  CHECK(list.list[2].line == 4);
  CHECK(tree->find("a")->number == 7.0);  // the last of several
  CHECK(tree->find("b")->find("c")->kind == JsonNode::Kind::Null);
  CHECK(tree->find("b")->find("d")->truth);
  CHECK(tree->find("b")->find("d")->line == 6);
  CHECK(tree->find("x") == nullptr);
}

TEST_CASE("Python's numbers that are none in JSON") {
  const auto tree = parse_json("[Infinity, -Infinity, NaN, \"Infinity\"]", "x.json");
  REQUIRE(tree.has_value());
  CHECK(tree->list[0].number == INFINITY);
  CHECK(tree->list[1].number == -INFINITY);
  CHECK(std::isnan(tree->list[2].number));
  CHECK(tree->list[3].text == "Infinity");
}

TEST_CASE("what is no JSON, and where") {
  check_json_refused("", "not valid JSON", 1);
  check_json_refused("{\n\"a\": 1,\n}", "not valid JSON", 3);
  check_json_refused("{\"a\": 1} 2", "not valid JSON", 1);
  check_json_refused("[1e999]", "not valid JSON", 1);
  check_json_refused("[\"\xff\"]", "not valid JSON", 1);
  check_json_refused(std::string("[\n").append(repeated("[", 500'000)), "nested deeper than 64", 2);
  check_json_refused(repeated("{\"a\":", 100'000), "nested deeper than 64", 1);
  check_json_refused(std::string("[").append(repeated("1,", 300'000)).append("1]"), "more than 200000 values", 1);
  check_json_refused(repeated(" ", kJsonMaxBytes + 1), "bytes", 0);
  CHECK(parse_json(repeated("[", 60) + repeated("]", 60), "x.json").has_value());
}

}  // namespace
}  // namespace contrejour
