// SPDX-License-Identifier: Apache-2.0
// Sessions as files: complete, tolerant of what they do not know, exact about what is wrong.
#include <doctest/doctest.h>

#include "contrejour/expert/session.h"
#include "studio/core/document.h"

namespace contrejour::studio {
namespace {

constexpr const char* kWithUnknown = R"({
  "contrejour-session": 1,
  "lens": "heliar",
  "future": {"b": [1, 2.5, "x"], "a": null},
  "values": {"fnumber": "8", "light-at": ["0.2,0.3:900", "0.7,0.6"]},
  "another": true
})";

TEST_CASE("a session that is written reads back as the same") {
  const Document first = first_document();
  const std::string text = write_session(session_of(first));
  const auto session = read_session(text, "a.session.json");
  REQUIRE(session);
  CHECK(write_session(*session) == text);
  const auto document = document_of(*session);
  REQUIRE(document);
  CHECK(document->texts == first.texts);
  CHECK_FALSE(document->lens_was_edited);
  CHECK(write_lens_toml(*document->lens) == write_lens_toml(*first.lens));
}

TEST_CASE("keys that are not known are kept, in their order") {
  const auto session = read_session(kWithUnknown, "a.session.json");
  REQUIRE(session);
  REQUIRE(session->others.size() == 2);
  CHECK(session->others[0] == SessionMember{"future", R"({"b":[1,2.5,"x"],"a":null})"});
  CHECK(session->others[1] == SessionMember{"another", "true"});
  const auto document = document_of(*session);
  REQUIRE(document);
  const auto again = read_session(write_session(session_of(*document)), "b.session.json");
  REQUIRE(again);
  CHECK(again->others == session->others);
  CHECK(again->values.list("light-at") == std::vector<std::string>{"0.2,0.3:900", "0.7,0.6"});
}

TEST_CASE("an embedded lens needs no file of its own") {
  Session session = session_of(first_document());
  session.lens = "/nowhere/my-lens.toml";
  const auto document = document_of(session);
  REQUIRE(document);
  CHECK(document->lens_was_edited);
  CHECK(document->lens->surfaces.size() == first_document().lens->surfaces.size());
}

std::string error_of(const std::string& json) {
  const auto session = read_session(json, "s.json");
  return session ? "" : session.error().to_string();
}

TEST_CASE("what is wrong with a session is named with its line") {
  CHECK(error_of("[]").find("no \"contrejour-session\"") != std::string::npos);
  CHECK(error_of("{\"contrejour-session\": 2}").find("later version") != std::string::npos);
  CHECK(error_of("{\"contrejour-session\": 1,\n\"values\": {\n\"fnumber\": \"x\"}}").starts_with("s.json:3: fnumber:"));
  CHECK(error_of("{\"contrejour-session\": 1,\n\"values\": {\"f-number\": \"8\"}}")
            .find("\"f-number\" is not a parameter") != std::string::npos);
  CHECK(error_of("{\"contrejour-session\": 1, \"values\": {\"fnumber\": [\"8\", \"9\"]}}").find("single value") !=
        std::string::npos);
  CHECK(error_of("{\"contrejour-session\": 1, \"lens\": 3}").find("\"lens\" is not a text") != std::string::npos);
  CHECK(error_of("{\"contrejour-session\": 1").starts_with("s.json"));
}

TEST_CASE("the names of sessions") {
  CHECK(is_session("a.session.json"));
  CHECK(is_session("/x/B.Session.JSON"));
  CHECK_FALSE(is_session("session.json"));
  CHECK_FALSE(is_session("a.json"));
}

}  // namespace
}  // namespace contrejour::studio
