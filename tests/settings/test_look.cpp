// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/lens.h"
#include "contrejour/look.h"

using namespace contrejour;
using namespace contrejour::params;

namespace {

Look must_read(std::string_view toml) {
  auto look = read_look(toml, "a.toml");
  REQUIRE_MESSAGE(look.has_value(), (look ? "" : look.error().to_string()));
  return *look;
}

void check_refused(std::string_view toml, int line, std::string_view part) {
  CAPTURE(toml);
  const auto look = read_look(toml, "a.toml");
  REQUIRE(!look.has_value());
  CHECK(look.error().place.file == "a.toml");
  CHECK(look.error().place.line == line);
  CHECK_MESSAGE(look.error().message.find(part) != std::string::npos, look.error().message);
}

}  // namespace

TEST_CASE("a look's values are the table's, by its names") {
  const Look look = must_read(
      "name = 'Dusk'\ndescription = \"one line\"\nlens = 'heliar'\n"
      "fnumber = 5.6\nblades = 7\nfocus = '2m'\ncoating = \"quarter-wave:500:1.38\"\n"
      "mirror-symmetry = true\nscale-grid = false\n");
  CHECK(look.name == "Dusk");
  CHECK(look.description == "one line");
  CHECK(look.lens == "heliar");
  CHECK(look.values.number("fnumber") == 5.6);
  CHECK(look.values.integer("blades") == 7);
  CHECK(look.values.text("focus") == "2m");
  CHECK(look.values.is_on("mirror-symmetry"));
  CHECK(!look.values.is_on("scale-grid"));
  CHECK(!look.values.given("wavelengths"));
}

TEST_CASE("a key's earlier name is read, and written as its present one") {
  const Look look =
      must_read("mirror = true\ndirt-on = 'stop'\ndirt-time = 0.5\nghost-scatter = 0.1\nblade-spread = 0\n");
  CHECK(look.values.is_on("mirror-symmetry"));
  CHECK(look.values.text("dirt-plane") == "stop");
  CHECK(look.values.number("dirt-phase") == 0.5);
  CHECK(look.values.number("ghost-jitter") == 0.1);
  CHECK(look.values.number("blade-slope-error") == 0.0);
  CHECK(write_look(look).find("ghost-jitter = 0.1") != std::string::npos);
  CHECK(write_look(look).find("ghost-scatter") == std::string::npos);
  check_refused("mirror = true\nmirror-symmetry = true", 2, "earlier name");
}

TEST_CASE("what a look cannot hold is refused with its line and what to do") {
  check_refused("\nfnumbr = 5.6", 2, "did you mean fnumber?");
  check_refused("blades = 300", 1, "from 0 to 100");
  check_refused("blades = 2", 1, "3 blades or more");
  check_refused("blades = \"+02\"", 1, "3 blades or more");
  check_refused("blades = 2.5", 1, "blades");
  check_refused("# a comment\n\nsize = \"4x4\"", 3, "scene");
  check_refused("mirror-symmetry = 1", 1, "true or false");
  check_refused("blades = true", 1, "give a value");
  check_refused("blades = [\"7\"]", 1, "not a list");
  check_refused("method = \"magic\"", 1, "magic");
  check_refused("fnumber = nan", 1, "finite");
  check_refused("fnumber = inf", 1, "finite");
  check_refused("name = 5", 1, "quotes");
  check_refused("[table]\na = 1", 1, "table");
  check_refused("a = {b = 1}", 1, "a is neither");
  check_refused("blades = 1979-05-27", 1, "blades");
  check_refused("blades = 7\nblades = 8", 2, "TOML");
  check_refused("blades =", 1, "TOML");
}

TEST_CASE("a look written is the look read, and names a value for every default") {
  const Look look = must_read(
      "name = \"A \\\"quoted\\\" name\"\nlens = 'heliar'\nblades = 9\nblade-rotation = 0.1\n"
      "mirror-symmetry = true\nerror = '0.01'\n");
  const std::string text = write_look(look);
  const Look again = must_read(text);
  CHECK(again.name == look.name);
  CHECK(again.lens == look.lens);
  CHECK(write_look(again) == text);
  for (const Parameter& p : all_parameters()) {
    CAPTURE(p.name);
    if (!belongs_to_look(p)) continue;
    CHECK(again.values.text(p.name).value_or("off") == look.values.text(p.name).value_or("off"));
    if (!p.fallback.empty()) CHECK(again.values.given(p.name));
  }
}

TEST_CASE("numbers as the command line takes them are written as TOML has them") {
  Look look;
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"starburst-gain", ".5"}, {"blade-rotation", "05."}, {"fnumber", "8e0"}, {"blades", "007"}}) {
    CAPTURE(text);
    if (!look.values.set(name, text)) continue;  // refused at once is as good
    const Look again = must_read(write_look(look));
    CHECK(again.values.number(name) == look.values.number(name));
  }
  CHECK(look.values.given("starburst-gain"));
}

TEST_CASE("values given stand over a look's") {
  Values given;
  REQUIRE(given.set("blades", "5").has_value());
  REQUIRE(given.set("mirror-symmetry", "off").has_value());
  const Look look = must_read("blades = 9\nfnumber = 8\nmirror-symmetry = true");
  const Values both = given.over(look.values);
  CHECK(both.integer("blades") == 5);
  CHECK(both.number("fnumber") == 8.0);
  CHECK(!both.is_on("mirror-symmetry"));
}

TEST_CASE("every bundled look is read, described and names a lens that there is") {
  const auto all = bundled_looks();
  CHECK(all.size() >= 10);
  for (const BundledLook& bundled : all) {
    CAPTURE(bundled.name);
    const auto look = find_look(std::string(bundled.name));
    REQUIRE_MESSAGE(look.has_value(), (look ? "" : look.error().to_string()));
    CHECK(!look->name.empty());
    CHECK(!look->description.empty());
    CHECK(find_lens(look->lens).has_value());
  }
}

TEST_CASE("looks by name or from a file; what is neither is refused") {
  CHECK(find_look("old-portrat").error().message.find("old-portrait") != std::string::npos);
  CHECK(!find_look("no/such/file.toml").has_value());
  CHECK(!find_look(".").has_value());
  const auto file = std::filesystem::temp_directory_path() / "contrejour-test-look.toml";
  std::ofstream(file) << "blades = 6\n";
  const auto look = find_look(file.string());
  REQUIRE(look.has_value());
  CHECK(look->values.integer("blades") == 6);
  std::filesystem::remove(file);
}
