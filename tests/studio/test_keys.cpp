// SPDX-License-Identifier: Apache-2.0
// Keys of a document's values, and its frames as the command line has them.
#include <doctest/doctest.h>

#include "studio/core/frame_values.h"
#include "studio/core/keys.h"
#include "studio/core/lights.h"
#include "support/approx.h"

namespace contrejour::studio {
namespace {

Document scene() {
  Document d = first_document();
  d = *with_lights(d, {{{0.25, 0.5}, "1000", "3200K", "", ""}, {{0.75, 0.5}, "900", "", "", ""}});
  return *with_value(d, "fnumber", "4");
}

Document edited(const Document& before, const Result<Document>& after, int frame) {
  REQUIRE(after);
  return with_keys_of_edit(before, *after, frame);
}

const TrackId kFNumber{"fnumber", 0, {}};
const TrackId kPosition{"", 0, LightPart::Position};

TEST_CASE("an edit at another frame is a key there, and between keys the value is theirs") {
  Document d = *with_key(scene(), kFNumber, 1);
  d = *with_interpolation(d, kFNumber, Interpolation::Linear);
  d = edited(d, with_value(at_frame(d, 11), "fnumber", "8"), 11);
  REQUIRE(keys_of(d, kFNumber));
  CHECK(keys_of(d, kFNumber)->keys == std::vector<Key>{{1, {4.0}, {}}, {11, {8.0}, {}}});
  CHECK(at_frame(d, 6).text("fnumber") == "6");
  CHECK(at_frame(d, 100).text("fnumber") == "8");
  CHECK(range_of_keys(d) == std::pair(1, 11));
  d = *with_interpolation(d, kFNumber, Interpolation::Step);
  CHECK(at_frame(d, 10).text("fnumber") == "4");
  // A value without keys stays the same in all frames.
  d = edited(d, with_value(d, "blades", "5"), 7);
  CHECK(at_frame(d, 3).text("blades") == "5");
  CHECK(tracks_of(d).size() == 1);
}

TEST_CASE("keys are moved and removed; the last one leaves the value") {
  Document d = *with_key(scene(), kFNumber, 1);
  d = *with_key(*with_value(d, "fnumber", "8"), kFNumber, 9);
  d = *with_key_moved(d, kFNumber, 9, 5);
  CHECK(keys_of(d, kFNumber)->keys.back().frame == 5);
  CHECK_FALSE(with_key_moved(d, kFNumber, 5, 1));
  d = *without_key(*without_key(d, kFNumber, 5), kFNumber, 1);
  CHECK_FALSE(has_keys(d));
  CHECK(d.text("fnumber") == "8");
  CHECK(d.animation == Animation{});
  CHECK_FALSE(with_key(d, {"size", 0, {}}, 1));
  CHECK_FALSE(with_key(d, {"hfov", 0, {}}, 1));  // nobody has set it
  CHECK_FALSE(with_key(d, {"", 1, LightPart::Size}, 1));
}

TEST_CASE("a light with keys moves, the others stay, and edits follow the light") {
  Document d = *with_key(scene(), kPosition, 1);
  d = edited(d, with_light_at(at_frame(d, 21), 0, {0.45, 0.5}), 21);
  CHECK(keys_of(d, kPosition)->keys.size() == 2);
  const auto middle = lights_of(at_frame(d, 11));
  REQUIRE(middle.size() == 2);
  CHECK(middle[0].at.x == test::approx(0.35));
  CHECK(middle[0].colour == "3200K");
  CHECK(middle[1] == lights_of(d)[1]);

  Document more = edited(d, with_new_light(d, {{0.5, 0.1}, "5", "", "", ""}), 21);
  CHECK(lights_of(at_frame(more, 1)).size() == 3);
  more = edited(more, without_light(more, 1), 21);
  const auto left = lights_of(at_frame(more, 1));
  REQUIRE(left.size() == 2);
  CHECK(left[0].at.x == test::approx(0.25));
  CHECK(left[1].at.y == test::approx(0.1));
  CHECK(lights_of(at_frame(more, 21))[0].at.x == test::approx(0.45));
}

TEST_CASE("keys are in the session as a lights file, and come back") {
  Document d = *with_key(*with_key(scene(), kPosition, 3), kFNumber, 2);
  const Session session = session_of(d);
  CHECK(session.animation.find("[[light]]") != std::string::npos);
  const auto again = document_of(*read_session(write_session(session), "a.session.json"));
  REQUIRE(again);
  CHECK(again->animation == d.animation);
  CHECK(again->texts == d.texts);
  Session damaged = session;
  damaged.animation = "[[light]]\nat = 3\n";
  CHECK_FALSE(document_of(damaged));
}

TEST_CASE("the values of a frame have the animation's lights in place of the document's") {
  Document d = *with_key(scene(), kPosition, 1);
  d = edited(d, with_light_at(at_frame(d, 3), 0, {0.27, 0.5}), 3);
  CHECK(values_of_frame(d, 1).list("light-at").size() == 2);
  CHECK(values_of_frame(d, 2).list("light-at")[0].starts_with("0.26,0.5:1000:3200K"));
  CHECK_FALSE(parameters_change_during(d, 2));
  d = *with_key(*with_value(d, "shutter-angle", "180"), kFNumber, 1);
  d = edited(d, with_value(at_frame(d, 5), "fnumber", "8"), 5);
  CHECK(parameters_change_during(d, 2));
  CHECK(values_of_frame(d, 2).list("light-at")[0].find('/') != std::string::npos);
}

TEST_CASE("a light that is off has no value where it is off") {
  Document d = *with_key(scene(), kPosition, 1);
  d.animation.lights[1].on = KeyedValue{{{1, {}, "on"}, {5, {}, "off"}}, Interpolation::Step};
  CHECK(lights_of(at_frame(d, 4))[1].value == "900");
  CHECK(lights_of(at_frame(d, 5))[1].value == "0");
}

}  // namespace
}  // namespace contrejour::studio
