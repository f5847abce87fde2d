// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

#include "contrejour/lens.h"
#include "contrejour/preset.h"

using namespace contrejour;
using namespace contrejour::params;

namespace {

Preset must_read(std::string_view toml) {
  auto preset = read_preset(toml, "a.toml");
  REQUIRE_MESSAGE(preset.has_value(), (preset ? "" : preset.error().to_string()));
  return *preset;
}

void check_refused(std::string_view toml, int line, std::string_view part) {
  CAPTURE(toml);
  const auto preset = read_preset(toml, "a.toml");
  REQUIRE(!preset.has_value());
  CHECK(preset.error().position.file == "a.toml");
  CHECK(preset.error().position.line == line);
  CHECK_MESSAGE(preset.error().message.find(part) != std::string::npos, preset.error().message);
}

}  // namespace

TEST_CASE("a preset's values are the table's, by its names") {
  const Preset preset = must_read(
      "name = 'Dusk'\ndescription = \"one line\"\nlens = 'heliar'\n"
      "fnumber = 5.6\nblades = 7\nfocus = '2m'\ncoating = \"quarter-wave:500:1.38\"\n"
      "mirror-symmetry = true\nscale-grid = false\n");
  CHECK(preset.name == "Dusk");
  CHECK(preset.description == "one line");
  CHECK(preset.lens == "heliar");
  CHECK(preset.values.number("fnumber") == 5.6);
  CHECK(preset.values.integer("blades") == 7);
  CHECK(preset.values.text("focus") == "2m");
  CHECK(preset.values.is_on("mirror-symmetry"));
  CHECK(!preset.values.is_on("scale-grid"));
  CHECK(!preset.values.given("wavelengths"));
}

TEST_CASE("a key's earlier name is read, and written as its present one") {
  const Preset preset =
      must_read("mirror = true\ndirt-on = 'stop'\ndirt-time = 0.5\nghost-scatter = 0.1\nblade-spread = 0\n");
  CHECK(preset.values.is_on("mirror-symmetry"));
  CHECK(preset.values.text("dirt-plane") == "stop");
  CHECK(preset.values.number("dirt-phase") == 0.5);
  CHECK(preset.values.number("ghost-jitter") == 0.1);
  CHECK(preset.values.number("blade-slope-error") == 0.0);
  CHECK(write_preset(preset).find("ghost-jitter = 0.1") != std::string::npos);
  CHECK(write_preset(preset).find("ghost-scatter") == std::string::npos);
  check_refused("mirror = true\nmirror-symmetry = true", 2, "earlier name");
}

TEST_CASE("what a preset cannot hold is refused with its line and what to do") {
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

TEST_CASE("a preset written is the preset read, and names a value for every default") {
  const Preset preset = must_read(
      "name = \"A \\\"quoted\\\" name\"\nlens = 'heliar'\nblades = 9\nblade-rotation = 0.1\n"
      "mirror-symmetry = true\nerror = '0.01'\n");
  const std::string text = write_preset(preset);
  const Preset again = must_read(text);
  CHECK(again.name == preset.name);
  CHECK(again.lens == preset.lens);
  CHECK(write_preset(again) == text);
  for (const Parameter& p : all_parameters()) {
    CAPTURE(p.name);
    if (!belongs_to_preset(p)) continue;
    CHECK(again.values.text(p.name).value_or("off") == preset.values.text(p.name).value_or("off"));
    if (!p.fallback.empty()) CHECK(again.values.given(p.name));
  }
}

TEST_CASE("numbers as the command line takes them are written as TOML has them") {
  Preset preset;
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"starburst-gain", ".5"}, {"blade-rotation", "05."}, {"fnumber", "8e0"}, {"blades", "007"}}) {
    CAPTURE(text);
    if (!preset.values.set(name, text)) continue;  // refused at once is as good
    const Preset again = must_read(write_preset(preset));
    CHECK(again.values.number(name) == preset.values.number(name));
  }
  CHECK(preset.values.given("starburst-gain"));
}

TEST_CASE("values given stand over a preset's") {
  Values given;
  REQUIRE(given.set("blades", "5").has_value());
  REQUIRE(given.set("mirror-symmetry", "off").has_value());
  const Preset preset = must_read("blades = 9\nfnumber = 8\nmirror-symmetry = true");
  const Values both = given.over(preset.values);
  CHECK(both.integer("blades") == 5);
  CHECK(both.number("fnumber") == 8.0);
  CHECK(!both.is_on("mirror-symmetry"));
}

TEST_CASE("every bundled preset is read, described and names a lens that there is") {
  const auto all = bundled_presets();
  CHECK(all.size() >= 10);
  for (const BundledPreset& bundled : all) {
    CAPTURE(bundled.name);
    const auto preset = find_preset(std::string(bundled.name));
    REQUIRE_MESSAGE(preset.has_value(), (preset ? "" : preset.error().to_string()));
    CHECK(!preset->name.empty());
    CHECK(!preset->description.empty());
    CHECK(find_lens(preset->lens).has_value());
  }
}

TEST_CASE("presets by name or from a file; what is neither is refused") {
  CHECK(find_preset("old-portrat").error().message.find("old-portrait") != std::string::npos);
  CHECK(!find_preset("no/such/file.toml").has_value());
  CHECK(!find_preset(".").has_value());
  const auto file = std::filesystem::temp_directory_path() / "contrejour-test-preset.toml";
  std::ofstream(file) << "blades = 6\n";
  const auto preset = find_preset(file.string());
  REQUIRE(preset.has_value());
  CHECK(preset->values.integer("blades") == 6);
  std::filesystem::remove(file);
}
