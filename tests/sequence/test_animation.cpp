// SPDX-License-Identifier: Apache-2.0
// Keys by frame: what lies between them, and what a file of lights says at each frame.
#include "contrejour/expert/animation.h"

#include <algorithm>
#include <string>

#include <doctest/doctest.h>

#include "contrejour/expert/parameter_text.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

KeyedValue keyed(std::vector<std::pair<int, double>> keys, Interpolation between) {
  KeyedValue value;
  for (const auto& [frame, number] : keys) value.keys.push_back({frame, {number}, {}});
  value.between = between;
  return value;
}

double at(const KeyedValue& value, double frame) { return params::parse_real(text_at(value, frame)).value(); }

Animation must_read(const std::string& toml) {
  auto read = read_animation(toml, "lights.toml");
  REQUIRE_MESSAGE(read.has_value(), (read ? "" : read.error().to_string()));
  return std::move(*read);
}

std::string error_of(const std::string& toml) {
  const auto read = read_animation(toml, "lights.toml");
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().code == ErrorCode::Parse);
  return read.error().to_string();
}

}  // namespace

TEST_CASE("steps and lines between keys, constant outside") {
  for (const auto between : {Interpolation::Step, Interpolation::Linear, Interpolation::Smooth}) {
    const KeyedValue value = keyed({{10, 1.0}, {20, 3.0}, {40, -1.0}}, between);
    CHECK(at(value, -100) == 1.0);
    CHECK(at(value, 10) == 1.0);
    CHECK(at(value, 20) == 3.0);
    CHECK(at(value, 40) == -1.0);
    CHECK(at(value, 1e9) == -1.0);
  }
  CHECK(at(keyed({{10, 1.0}, {20, 3.0}}, Interpolation::Linear), 12.5) == 1.5);
  CHECK(at(keyed({{10, 1.0}, {20, 3.0}}, Interpolation::Step), 19.9) == 1.0);
}

TEST_CASE("a smooth curve has no corner at a key and stays between its keys") {
  const KeyedValue value = keyed({{0, 0.0}, {10, 1.0}, {30, 8.0}, {40, 8.0}, {50, 2.0}}, Interpolation::Smooth);
  constexpr double kStep = 1e-3;
  for (const int key : {0, 10, 30, 40, 50}) {
    CAPTURE(key);
    const double before = (at(value, key) - at(value, key - kStep)) / kStep;
    const double after = (at(value, key + kStep) - at(value, key)) / kStep;
    CHECK(before == test::approx(after).epsilon(0.02).scale(1.0));
  }
  for (double frame = 0; frame < 50; frame += 0.37) {
    const double now = at(value, frame), next = at(value, frame + 0.37);
    if (frame + 0.37 <= 40) CHECK(next >= now - 1e-12);
    if (frame >= 40) CHECK(next <= now + 1e-12);
    CHECK(now >= -1e-12);
    CHECK(now <= 8.0 + 1e-12);
  }
  // Two keys alone: the cubic 3 t^2 - 2 t^3.
  CHECK(at(keyed({{0, 0.0}, {10, 1.0}}, Interpolation::Smooth), 2.5) == test::approx(0.15625));
}

TEST_CASE("a file's lights and parameters at each frame") {
  const Animation shot = must_read(R"([parameters]
fnumber = { 1001 = 4, 1011 = 16 }
blades = { 1001 = 5, 1011 = 8 }
starburst = { 1001 = false, 1005 = true }

[[light]]
name = "lamp"
at = { 1001 = [0.1, 0.4], 1011 = [0.9, 0.2] }
value = { 1001 = 5000, 1011 = 6000 }
distance = 2500
on = { 1001 = true, 1011 = false }

[[light]]
direction = [5, -3]
value = [1, 2, 3]
colour = "3200K"
size = 0.5
)");
  CHECK(first_key(shot) == 1001);
  const auto values_at = [&](double frame) {
    params::Values values = parameters_at(shot, frame);
    add_lights_at(shot, frame, values);
    return values;
  };
  CHECK(values_at(1006).number("fnumber") == test::approx(10.0));
  CHECK(values_at(1002).integer("blades") == 5);
  CHECK(values_at(1006).integer("blades") == 7);
  CHECK_FALSE(values_at(1004).is_on("starburst"));
  CHECK(values_at(1005).is_on("starburst"));

  const auto lamp = params::parse_light(values_at(1006).list("light-at").at(0)).value();
  CHECK(lamp.path.front().x == test::approx(0.5));
  CHECK(lamp.path.front().y == test::approx(0.3));
  CHECK(lamp.value->rgb[0] == test::approx(5500));
  CHECK_FALSE(lamp.colour.has_value());
  CHECK(lamp.distance_mm == 2500.0);
  CHECK(values_at(1011).list("light-at").empty());

  const auto sun = params::parse_light(values_at(1011).list("light").at(0)).value();
  CHECK(sun.value->rgb == Rgb{1, 2, 3});
  CHECK(sun.size_deg == 0.5);
  CHECK_FALSE(sun.distance_mm.has_value());
}

TEST_CASE("a file is written and read the same") {
  Animation shot = must_read(R"([parameters]
focal = { 1001 = 70, 1002 = 70.1, 1003 = 70.30000000000001, 1004 = 71, 1005 = 1e2, between = "smooth" }
detect = false
focus = "2m"
fnumber = { -3 = 4, 12 = 0.3333333333333333 }

[[light]]
name = "a \"quoted\" \u0007 name"
at = { 1 = [0.1, 0.2], 2 = [0.30000000000000004, -7], 4 = [1, 1], 5 = [1, 1], 9 = [1, 0] }
value = { 7 = "12stops" }
colour = "3200K"
on = { 1 = true, 2 = false, 3 = true, 4 = false, 5 = true, between = "step" }

[[light]]
direction = [12, 20]
value = [1, 2, 3]
size = { 1 = 0.53, 4 = 0.6, between = "step" }
distance = "inf"
)");
  CHECK(must_read(write_animation(shot)) == shot);
  CHECK(must_read(write_animation(Animation())) == Animation());
  // Every bit of awkward numbers survives, in one line and in a table.
  for (const double number : {1.0 / 3.0, 1e-300, -5e-324, 123456789012345.6, 0.1 + 0.2}) {
    shot.lights[0].position.keys = {{0, {number, -number}, {}}};
    shot.lights[1].position.keys.clear();
    for (int frame = 1; frame < 9; ++frame) shot.lights[1].position.keys.push_back({frame, {number / frame, 1.0}, {}});
    CHECK(must_read(write_animation(shot)) == shot);
  }
}

TEST_CASE("errors name the line and the remedy") {
  const auto says = [](const std::string& error, const char* what) {
    CAPTURE(error);
    CHECK(error.find(what) != std::string::npos);
  };
  says(error_of("[[light]]\nvalue = 3\n"), "lights.toml:1: light 1: give either at");
  says(error_of("[[light]]\nat = [0.5]\n"), "lights.toml:2");
  says(error_of("[[light]]\nat = [0.5, 0.5]\nvalue = -1\n"), "lights.toml:3");
  says(error_of("[[light]]\nat = [0.5, 0.5]\ndirection = [1, 1]\n"), "give either at");
  says(error_of("[[light]]\nat = [0.5, 0.5]\non = 3\n"), "true or false");
  says(error_of("[[light]]\nat = { 1 = [0, 0], a = [1, 1] }\n"), "\"a\" is not the number of a frame");
  says(error_of("[[light]]\nat = { 1 = [0, 0], 01 = [1, 1] }\n"), "two keys");
  says(error_of("[[light]]\nat = { 1 = [0, 0], 2 = 3 }\n"), "different kinds");
  says(error_of("[[light]]\nat = { between = \"linear\" }\n"), "no key");
  says(error_of("[[light]]\nat = { 1 = [0, 0], between = \"soft\" }\n"), "\"smooth\"");
  says(error_of("[[light]]\nat = []\n"), "empty");
  says(error_of("[[light]]\nname = \"a\"\nat = [0, 0]\n[[light]]\nname = \"a\"\nat = [0, 0]\n"), "two lights");
  says(error_of("[parameters]\nfnumbr = 3\n"), "did you mean fnumber?");
  says(error_of("[parameters]\nsize = \"64x64\"\n"), "not a parameter that can change");
  says(error_of("[parameters]\nfnumber = { 1 = 4, 2 = -1 }\n"), "lights.toml:2");
  says(error_of("lights = 3\n"), "unknown key");
}

TEST_CASE("while the shutter is open a light takes a path and has the mean of its value") {
  const Animation animation = must_read(
      "[[light]]\nat = { 0 = [0.1, 0.5], 8 = [0.9, 0.5] }\nvalue = { 0 = 100, 8 = 900 }\ncolour = \"3200K\"\n");
  const auto text = [&](double frame, Shutter shutter) {
    params::Values values;
    add_lights_at(animation, frame, values, shutter);
    return values.list("light-at").front();
  };
  const auto light = [&](double frame, Shutter shutter) { return params::parse_light(text(frame, shutter)).value(); };
  CHECK(text(4, {}) == "0.5,0.5:500:3200K");
  const params::LightText half = light(2, {.angle_deg = 180});
  REQUIRE(half.path.size() > 2);
  CHECK(half.path.front().x == test::approx(0.3));
  CHECK(half.path.back().x == test::approx(0.35));
  CHECK(half.path.front().y == 0.5);
  CHECK(half.value->rgb[0] == test::approx(325));
  const params::LightText centred = light(2, {.angle_deg = 180, .centred = true});
  CHECK(centred.path.front().x == test::approx(0.275));
  CHECK(centred.path.back().x == test::approx(0.325));
  CHECK(centred.value->rgb[0] == test::approx(300));
  CHECK(light(9, {.angle_deg = 360}).path.size() == 1);  // it stands still
}

TEST_CASE("paths of lights as text") {
  const auto path = params::parse_light("0.1,0.2/0.3,0.4/0.5,0.6:5000");
  REQUIRE(path);
  CHECK(path->path == std::vector<Vec2>{{0.1, 0.2}, {0.3, 0.4}, {0.5, 0.6}});
  for (const char* text : {"0.1,0.2/", "/0.1,0.2", "0.1,0.2/0.3", "0.1,0.2//0.3,0.4"})
    CHECK_FALSE(params::parse_light(text));
  std::string many = "0,0";
  for (int k = 0; k < 64; ++k) many += "/0,0";
  CHECK_FALSE(params::parse_light(many));
}
TEST_CASE("what changes gradually while the shutter is open is that of each time, all else that of the frame") {
  const auto shot = read_animation(
      "[parameters]\n"
      "focal = { 1 = 70, 2 = 80 }\n"
      "fnumber = { 1 = 4, 2 = 8, between = \"step\" }\n"
      "blades = { 1 = 5, 3 = 9 }\n"
      "threshold = { 1 = 2, 2 = 4 }\n"
      "dirt-plane = { 1 = \"front\", 2 = \"stop\" }\n"
      "[[light]]\nat = { 1 = [0.2, 0.4], 2 = [0.4, 0.4] }\nvalue = 10\non = { 1 = true, 2 = false }\n",
      "shot.toml");
  REQUIRE(shot);
  const Shutter half{180.0, false}, centred{180.0, true};
  CHECK(time_of_exposure(1, half, 0.0) == 1.0);
  CHECK(time_of_exposure(1, half, 1.0) == 1.5);
  CHECK(time_of_exposure(2, centred, 0.0) == 1.75);
  const params::Values values = parameters_during(*shot, 1, 1.5);
  CHECK(values.text("focal") == "75");
  CHECK(values.text("fnumber") == "4");
  CHECK(values.text("blades") == "5");
  CHECK(values.text("threshold") == "2");
  CHECK(values.text("dirt-plane") == "front");
  CHECK(do_lights_move(*shot, 1, half));
  CHECK(!do_lights_move(*shot, 1, {}));
  CHECK(!do_lights_move(*shot, 2, half));  // off
  params::Values at_time;
  add_lights_at(*shot, 1, at_time, half, {0.5, 0.5});
  CHECK(at_time.list("light-at") == std::vector<std::string>{"0.25,0.4:10"});
  params::Values on_its_way;
  add_lights_at(*shot, 1, on_its_way, half, {0.5, 1.0});
  REQUIRE(on_its_way.list("light-at").size() == 1);
  CHECK(on_its_way.list("light-at").front().starts_with("0.25,0.4/"));
}
