// SPDX-License-Identifier: Apache-2.0
// Every parameter as a host sees it.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>

#include "contrejour/expert/parameter.h"
#include "contrejour/lens.h"
#include "contrejour/preset.h"
#include "scenes.h"

using namespace contrejour;
using namespace contrejour::openfx;

namespace {

bool is_identifier(const std::string& text) {
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::ranges::all_of(text, [](unsigned char c) { return c < 128 && (std::isalnum(c) != 0 || c == '_'); });
}

template <class Number>
void check_number(const ParamStruct& param) {
  const PropertySetStruct& properties = param.properties;
  REQUIRE(properties.count(name::kDefault) > 0);
  for (std::size_t k = 0; k < properties.count(name::kDefault); ++k) {
    for (const char* const bound : {name::kMin, name::kMax, name::kDisplayMin, name::kDisplayMax})
      REQUIRE(properties.count(bound) == properties.count(name::kDefault));
    const Number fallback = properties.get<Number>(name::kDefault, k);
    const Number low = properties.get<Number>(name::kMin, k), high = properties.get<Number>(name::kMax, k);
    const Number display_low = properties.get<Number>(name::kDisplayMin, k);
    const Number display_high = properties.get<Number>(name::kDisplayMax, k);
    CHECK((low <= display_low && display_low < display_high && display_high <= high));
    CHECK((display_low <= fallback && fallback <= display_high));
  }
}

void check_choice(const ParamStruct& param) {
  std::set<std::string> options;
  for (std::size_t k = 0; k < param.properties.count(name::kChoiceOption); ++k)
    options.insert(param.properties.get<std::string>(name::kChoiceOption, k));
  CHECK(options.size() == param.properties.count(name::kChoiceOption));
  CHECK_FALSE(options.contains(""));
  CHECK(param.properties.get<int>(name::kDefault, 0, -1) >= 0);
  CHECK(param.properties.get<int>(name::kDefault, 0, -1) < static_cast<int>(options.size()));
}

void check_param(const ParamStruct& param) {
  CAPTURE(param.name);
  CHECK(is_identifier(param.name));
  CHECK_FALSE(param.properties.get<std::string>(name::kLabel).empty());
  if (param.type != type::kGroup) CHECK_FALSE(param.properties.get<std::string>(name::kHint).empty());
  if (param.type == type::kInteger) check_number<int>(param);
  if (param.type == type::kDouble || param.type == type::kDouble2D || param.type == type::kRgb)
    check_number<double>(param);
  if (param.type == type::kChoice) check_choice(param);
}

// The name that a row of the table has in scripts.
std::string name_of(const params::Parameter& row) {
  std::string script(row.former.empty() ? row.name : row.former);
  std::ranges::replace(script, '-', '_');
  return script;
}

}  // namespace

TEST_CASE("openfx: parameters have names, labels, defaults within ranges, and groups that precede them") {
  const TestHost host;
  for (const char* context : {context::kFilter, context::kGeneral, context::kGenerator}) {
    const auto described = host.describe(context);
    std::set<std::string> names, labels, groups;
    for (const auto& param : described->params.params) {
      check_param(*param);
      CHECK(names.insert(param->name).second);
      CHECK(labels.insert(param->type + param->properties.get<std::string>(name::kLabel)).second);
      if (param->type == type::kGroup) groups.insert(param->name);
      const auto parent = param->properties.get<std::string>(name::kParent);
      CHECK((param->type == type::kGroup ? parent.empty() : groups.contains(parent)));
    }
  }
}

TEST_CASE("openfx: every row of the library's table is a parameter, but four that a host decides") {
  const TestHost host;
  const auto described = host.describe(context::kFilter);
  const std::set<std::string> decided_by_host = {"size", "pixel_aspect", "exposure", "wavelength"};
  for (const params::Parameter& row : params::all_parameters()) {
    CAPTURE(row.name);
    CHECK((described->params.find(name_of(row)) != nullptr) != decided_by_host.contains(name_of(row)));
  }
}

// Projects store these names and types. A line may be added here, none be changed.
TEST_CASE("openfx: parameters of earlier releases are all there, with their types") {
  const TestHost host;
  const auto described = host.describe(context::kFilter);
  std::ifstream list(CONTREJOUR_OPENFX_PARAMETERS);
  REQUIRE(list.good());
  std::string parameter, type;
  int count = 0;
  for (; list >> parameter >> type; ++count) {
    CAPTURE(parameter);
    REQUIRE(described->params.find(parameter) != nullptr);
    CHECK(described->params.find(parameter)->type == type);
  }
  CHECK(count > 90);
}

TEST_CASE("openfx: menus have every bundled lens and look, and nothing else") {
  const TestHost host;
  const auto described = host.describe(context::kFilter);
  const PropertySetStruct& lenses = described->params.find("lens")->properties;
  const PropertySetStruct& looks = described->params.find("look")->properties;
  REQUIRE(lenses.count(name::kChoiceOption) == bundled_lenses().size() + 1);
  REQUIRE(looks.count(name::kChoiceOption) == params::bundled_presets().size() + 1);
  for (std::size_t k = 1; k < lenses.count(name::kChoiceOption); ++k)
    CHECK(find_lens(lenses.get<std::string>(name::kChoiceOption, k)).has_value());
  for (std::size_t k = 1; k < looks.count(name::kChoiceOption); ++k)
    CHECK(params::find_preset(looks.get<std::string>(name::kChoiceOption, k)).has_value());
}

TEST_CASE("openfx: an untouched instance gives the library's defaults, and a touched one its values [slow]") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  scene.effect().choose("lens", "tessar");
  scene.effect().set("fnumber", {5.6});
  scene.effect().set("blades", {7.0});
  scene.effect().choose("colour_space", "acescg");
  scene.effect().set_text("select", "brightest:5");
  scene.effect().set_text("ghost", "1:gain=0.5; 3:gain=2");
  scene.effect().set_text("coating_at", "1:none");
  REQUIRE(scene.render() == status::kOk);
  REQUIRE(scene.effect().message == "");
  auto values = values_of({{"fnumber", "5.6"},
                           {"blades", "7"},
                           {"select", "brightest:5"},
                           {"ghost", "1:gain=0.5"},
                           {"ghost", "3:gain=2"},
                           {"coating-at", "1:none"},
                           {"light-at", kLightAt}});
  auto prescription = find_lens("tessar");
  const auto state = params::lens_of(std::move(*prescription), values);
  const Frame frame = params::whole_frame(values, *state, {kWidth, kHeight});
  const auto lights = params::lights(values, *state, frame, ColourSpace::AcesCg);
  const auto flare = contrejour::render(AdaptiveOptions{}, *state, *lights,
                                        params::frame_settings(values, frame, ColourSpace::AcesCg));
  REQUIRE(flare.has_value());
  CHECK(sum_of(scene.output) > 0.0);
  CHECK(differing_samples(scene.output, flare->image) == 0);
}

TEST_CASE("openfx: a look holds beneath the parameters, and its button loads it into them [slow]") {
  const TestHost host;
  Scene scene(host, context::kGenerator);
  scene.effect().choose("look", "old-portrait");
  scene.effect().set("blades", {6.0});  // the look has 12
  REQUIRE(scene.render() == status::kOk);
  auto values = values_of({{"blades", "6"}, {"light-at", kLightAt}});
  values = values.over(params::find_preset("old-portrait")->values);
  const Image expected = library_flare(values, "heliar");
  CHECK(differing_samples(scene.output, expected) == 0);

  PropertySetStruct in;
  in.put<std::string>(name::kName, {"loadLook"});
  in.put<std::string>(name::kChangeReason, {"OfxChangePluginEdited"});
  CHECK(host.act(action::kInstanceChanged, &scene.effect(), &in) == status::kReplyDefault);
  in.put<std::string>(name::kChangeReason, {value::kUserEdited});
  in.put<double>(name::kTime, {1.0});
  REQUIRE(host.act(action::kInstanceChanged, &scene.effect(), &in) == status::kOk);
  CHECK(scene.effect().param("look").numbers[0] == 0.0);
  CHECK(scene.effect().param("blades").numbers[0] == 12.0);
  CHECK(scene.effect().param("starburst").numbers[0] == 1.0);
  CHECK(scene.effect().param("fnumber").numbers[0] == 11.0);
  scene.effect().set_text("wavelengths", kWavelengths);
  scene.effect().set("blades", {6.0});
  REQUIRE(scene.render() == status::kOk);
  CHECK(differing_samples(scene.output, expected) == 0);
}
