// SPDX-License-Identifier: Apache-2.0
// Any preset within the table's ranges renders, or is refused with a reason: never a crash, never a NaN.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <doctest/doctest.h>

#include "contrejour/expert/settings.h"
#include "contrejour/preset.h"

using namespace contrejour;
using namespace contrejour::params;

namespace {

using Words = std::vector<std::string>;

// Values of parameters whose form alone the table checks, and narrower ranges for parameters that cost time, so that a
// few hundred presets are quick.
const std::map<std::string_view, Words> kTexts = {
    {"focus", {"inf", "2m", "500", "1e9", "350mm"}},
    {"cover-glass", {"2", "1:1.52:0.5", "3:N-SF11:10"}},
    {"coating", {"none", "quarter-wave", "quarter-wave:450:1.38", "hullin:550:1.38", "stack:1.38@99.6,2.1@131"}},
    {"method",
     {"adaptive", "adaptive", "adaptive", "bundle", "bundle", "bundle", "tiled", "tiled", "tiled", "reference"}},
    {"select", {"list:1-2,2-5", "list:1-5", "list:2-3", "list:3-5", "surface:2", "brightest:3"}},
    {"error", {"preview", "standard", "0.1"}},
    {"wavelengths", {"1", "1", "1", "1", "2", "2", "2", "3", "3", "auto"}},
    {"ghost", {"2-5:gain=0.5", "1-2:colour=1,0,0.5,offset=0.1,-0.2", "2-3:offset=3,0"}},
    {"ghost-ramp", {"0:1,0.5,0.2", "-1:1,0.5,0/0:1,1,1/1:0,0,2"}},
};
const std::map<std::string_view, std::pair<double, double>> kNarrowed = {{"grid", {16, 32}},
                                                                         {"density", {0.05, 0.1}},
                                                                         {"fnumber", {3.0, 64}},
                                                                         {"points", {0, 64}},
                                                                         {"sensor-orders", {0, 1}}};

// Without symmetry, searches for pupils take most of a preset's time; this is how often such settings are left out.
const std::map<std::string_view, double> kDear = {
    {"decentre", 0.8}, {"tilt", 0.8}, {"sensor-reflectance", 0.95}, {"reflections", 0.9}};

class RandomPreset {
 public:
  explicit RandomPreset(unsigned seed) : random_(seed) {}

  std::string text() {
    std::string out;
    for (const Parameter& p : all_parameters()) {
      if (!belongs_to_preset(p) || p.name == "focal" || chance(0.4)) continue;  // the lenses are no zooms
      if (const auto dear = kDear.find(p.name); dear != kDear.end() && chance(dear->second)) continue;
      const std::string value = value_of(p);
      if (!value.empty()) out += std::string(p.name) + " = " + value + "\n";
    }
    // Whatever the other values are, settings that would take seconds are replaced.
    for (const auto& [name, value] :
         std::map<std::string_view, std::string>{{"grid", "16"}, {"density", "0.05"}, {"wavelengths", "2"}}) {
      if (out.find(std::string(name) + " = ") == std::string::npos) out += std::string(name) + " = " + value + "\n";
    }
    const auto has = [&](const char* line) { return out.find(line) != std::string::npos; };
    if (has("reflections = \"4\"") && has("wavelengths = \"auto\"")) return text();  // a minute and a half
    return out;
  }

 private:
  bool chance(double fraction) { return std::uniform_real_distribution<>(0.0, 1.0)(random_) < fraction; }
  template <class List>
  const auto& any(const List& list) {
    return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(random_)];
  }

  double number(const Parameter& p) {
    double low = std::max(p.minimum, -1e6);
    double high = std::min(p.maximum, 1e6);
    if (const auto narrow = kNarrowed.find(p.name); narrow != kNarrowed.end()) std::tie(low, high) = narrow->second;
    if (chance(0.1)) return low;
    if (chance(0.1)) return high;
    if (low >= 0.0 && high > 100.0 * std::max(low, 1e-3)) {  // many decades: each equally likely
      return std::exp(std::uniform_real_distribution<>(std::log(std::max(low, 1e-3)), std::log(high))(random_));
    }
    return std::uniform_real_distribution<>(low, high)(random_);
  }

  std::string value_of(const Parameter& p) {
    switch (p.kind) {
      case Kind::Real: return std::to_string(std::clamp(number(p), p.minimum, p.maximum));
      case Kind::Integer: {
        const std::string whole =
            std::to_string(static_cast<long>(std::clamp(std::floor(number(p)), p.minimum, p.maximum)));
        return check_value(p, whole) ? whole : std::string(p.fallback);  // a single blade makes no iris
      }
      case Kind::Choice:
        if (p.name == "ringing" && chance(0.85)) return {};  // tenths of a second
        return '"' + std::string(any(p.choices)) + '"';
      case Kind::Switch: return chance(p.name == "starburst" ? 0.05 : 0.5) ? "true" : "false";  // a tenth of a second
      case Kind::Text: break;
    }
    const auto words = kTexts.find(p.name);
    return words == kTexts.end() ? std::string() : '"' + any(words->second) + '"';
  }

  std::mt19937 random_;
};

// Returns false if the preset is refused; such an error must have a reason.
bool renders(const std::string& text, const char* lens_name) {
  CAPTURE(text);
  const auto preset = read_preset(text, "random.toml");
  REQUIRE_MESSAGE(preset.has_value(), (preset ? "" : preset.error().to_string()));
  const auto prescription = find_lens(lens_name);
  REQUIRE(prescription.has_value());
  const auto settings = lens_settings(preset->values);
  if (!settings) {
    CHECK(!settings.error().message.empty());
    return false;
  }
  const auto lens = configure_lens(*prescription, *settings);
  if (!lens) {
    CHECK(!lens.error().message.empty());
    return false;
  }
  const Frame frame = whole_frame(preset->values, *lens, {24, 16});
  const auto space = colour_space(preset->values, ColourSpace::Rec709);
  const auto given = lights(preset->values, *lens, frame, space);
  REQUIRE(given.has_value());
  const auto flare =
      render(method_options(preset->values), *lens, *given, frame_settings(preset->values, frame, space));
  if (!flare) {
    CHECK(!flare.error().message.empty());
    return false;
  }
  CHECK(std::all_of(flare->image.pixels.begin(), flare->image.pixels.end(), [](float v) { return std::isfinite(v); }));
  return true;
}

int rendered(int count, unsigned seed) {
  RandomPreset random(seed);
  int done = 0;
  for (int k = 0; k < count; ++k) done += renders(random.text(), k % 2 == 0 ? "heliar" : "tessar") ? 1 : 0;
  return done;
}

}  // namespace

TEST_CASE("random presets render without error or NaN") { CHECK(rendered(40, 1) >= 20); }

TEST_CASE("a hundred of them [slow]") { CHECK(rendered(100, 2) >= 50); }

TEST_CASE("each end of each range, all else as usual [slow]") {
  for (const Parameter& p : all_parameters()) {
    if (!belongs_to_preset(p) || (p.kind != Kind::Real && p.kind != Kind::Integer)) continue;
    for (const double end : {p.minimum, p.maximum}) {
      if (!std::isfinite(end)) continue;
      CAPTURE(p.name);
      std::string text = std::string(p.name) + " = " +
                         (p.kind == Kind::Integer ? std::to_string(static_cast<long>(end)) : std::to_string(end)) +
                         "\n";
      for (const std::string_view method : render_methods()) {
        const bool reference = method_traits(method)->is_slow;  // minutes for most others
        if (reference != (p.name == "density") || (reference && end > 1.0)) continue;
        std::string rest = "method = \"" + std::string(method) + "\"\n";
        if (p.name != "grid") rest += "grid = 24\n";
        if (p.name != "density") rest += "density = 0.1\n";
        if (p.name == "points") rest += "wavelengths = \"1\"\n";  // 67 million points take a second for each
        // Ghosts do not differ in what the table's values do to them; all of them by the other methods take a minute.
        if (method != "adaptive" && p.name != "select") rest += "select = \"list:2-5\"\n";
        renders(text + rest, "heliar");
      }
    }
  }
}
