// SPDX-License-Identifier: Apache-2.0
#include "openfx/parameter_list.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "contrejour/lens.h"
#include "contrejour/preset.h"
#include "openfx/transfer.h"

namespace contrejour::openfx {
namespace {

// Menus keep their order for ever, because hosts store the index of an entry. Later lenses and presets come after
// these.
constexpr std::array<std::string_view, 15> kLensOrder = {"angenieux-double-gauss",
                                                         "canon-70-200",
                                                         "canon-rf-50",
                                                         "cooke-triplet",
                                                         "distagon-25",
                                                         "heliar",
                                                         "itoh-zoom",
                                                         "master-prime-50",
                                                         "muller-fisheye-10",
                                                         "nakamura-22",
                                                         "nikon-80-200",
                                                         "planar-50",
                                                         "schneider-anamorphic-31",
                                                         "sigler-telephoto-250",
                                                         "tessar"};
constexpr std::array<std::string_view, 11> kLookOrder = {
    "amber-wide", "bare-triplet", "cinema-prime", "fisheye-sun",    "long-telephoto", "modern-zoom",
    "night-zoom", "old-portrait", "press-camera", "sixties-normal", "violet-dream"};

template <class Bundled>
std::vector<std::string> in_order(const std::vector<Bundled>& bundled, std::span<const std::string_view> order) {
  std::vector<std::string> menu(order.begin(), order.end());
  for (const Bundled& entry : bundled)
    if (std::ranges::find(order, entry.name) == order.end()) menu.emplace_back(entry.name);
  return menu;
}

ParamSpec group(std::string name, std::string label, bool open = false) {
  ParamSpec spec{.name = std::move(name), .label = std::move(label), .hint = {}, .group = {}, .type = ParamType::Group};
  spec.open = open;
  return spec;
}

ParamSpec choice(std::string name, std::string label, std::string hint, std::vector<std::string> choices,
                 double fallback = 0.0) {
  ParamSpec spec{.name = std::move(name), .label = std::move(label), .hint = std::move(hint), .group = {}};
  spec.type = ParamType::Choice;
  spec.choices = std::move(choices);
  spec.fallback = {fallback};
  return spec;
}

ParamSpec simple(ParamType type, std::string name, std::string label, std::string hint, double fallback = 0.0) {
  ParamSpec spec{
      .name = std::move(name), .label = std::move(label), .hint = std::move(hint), .group = {}, .type = type};
  spec.fallback = {fallback};
  return spec;
}

class ListMaker {
 public:
  void begin(ParamSpec group) {
    group_ = group.name;
    list_.push_back(std::move(group));
  }
  void add(ParamSpec spec) {
    spec.group = group_;
    list_.push_back(std::move(spec));
  }
  void add_rows(std::string_view table_group) {
    for (const params::Parameter& row : params::all_parameters())
      if (row.group == table_group && belongs_to_plugin(row)) add(spec_of_row(row));
  }
  std::vector<ParamSpec> take() { return std::move(list_); }

 private:
  std::string group_;
  std::vector<ParamSpec> list_;
};

void add_lens(ListMaker& maker) {
  std::vector<std::string> looks = look_menu(), lenses = lens_menu();
  looks.insert(looks.begin(), "none");
  lenses.insert(lenses.begin(), "of the look");
  maker.begin(group("groupLook", "Look and lens", true));
  maker.add(choice(own::kLook, "Look",
                   "settings to start from; a parameter that is animated or not at its default overrides the look",
                   std::move(looks)));
  maker.add(simple(ParamType::File, own::kLookFile, "Look file", "a look of your own, in place of the menu's"));
  maker.add(simple(ParamType::Button, own::kLoadLook, "Load look into parameters",
                   "sets every parameter below as the look does, and the look to none"));
  maker.add(choice(own::kLens, "Lens", fmt::format("a bundled lens; without a look that names one: {}", kDefaultLens),
                   std::move(lenses)));
  maker.add(simple(ParamType::File, own::kLensFile, "Lens file",
                   "a lens file, or a measured flare (NAME.flare.toml), in place of the menu's lens"));
}

void add_lights(ListMaker& maker, EffectContext context) {
  for (int k = 1; k <= own::kLights; ++k) {
    const bool is_on = context == EffectContext::Generator && k == 1;
    maker.add(simple(ParamType::Boolean, own::light_on(k), fmt::format("Light {}", k), "switches this light on",
                     is_on ? 1.0 : 0.0));
    ParamSpec position = simple(ParamType::Position, own::light_position(k), fmt::format("Light {} position", k),
                                "of the light's image: 0,0 is the lower left corner of the frame, 1,1 the upper right; "
                                "it may lie outside");
    position.fallback = {0.7, 0.67};
    position.minimum = -100.0, position.maximum = 100.0;
    position.display_minimum = -1.0, position.display_maximum = 2.0;
    maker.add(std::move(position));
    ParamSpec value = simple(ParamType::Real, own::light_value(k), fmt::format("Light {} brightness", k),
                             "the sum of the light's image over its pixels, with white at 1; 0: the brightness of "
                             "Value, which may have a unit",
                             20000.0);
    value.maximum = 1e15, value.display_maximum = 200000.0;
    maker.add(std::move(value));
    ParamSpec colour = simple(ParamType::Colour, own::light_colour(k), fmt::format("Light {} colour", k),
                              "multiplies the brightness; white: the colour that Colour names");
    colour.fallback = {1.0, 1.0, 1.0};
    colour.maximum = 1e4, colour.display_maximum = 1.0;
    maker.add(std::move(colour));
  }
  maker.add(simple(ParamType::File, own::kLightsFile, "Lights file",
                   "lights and parameters with keys by frame, as `contrejour lights track` writes them"));
}

void add_output(ListMaker& maker, EffectContext context, bool is_display_referred) {
  maker.begin(group("groupOutput", "Output", true));
  maker.add(choice(own::kOutput, "Output", "the picture that the effect gives",
                   {"source and flare", "flare", "detected lights"}));
  maker.add(
      choice(own::kAlpha, "Alpha", "the output's alpha; without a source, source is 1", {"source", "0", "flare"}));
  const auto curve = is_display_referred ? TransferCurve::Srgb : TransferCurve::Linear;
  maker.add(choice(own::kTransfer, "Pixels are coded as",
                   "the curve of the source's and the output's pixels; light adds in scene-linear", transfer_menu(),
                   static_cast<double>(curve)));
  if (context != EffectContext::Generator)
    maker.add(
        choice(own::kFrame, "Frame of the sensor", "the rectangle that the lens's sensor sees", {"project", "source"}));
  maker.add(simple(ParamType::Boolean, own::kDraft, "Draft while dragging",
                   "a coarser flare while the host says that a parameter is being changed", 1.0));
}

// The table's groups that have a place of their own above; others follow in the order of the table.
void add_other_groups(ListMaker& maker) {
  std::vector<std::string_view> done = {"Lights", "Lens"};
  for (const params::Parameter& row : params::all_parameters()) {
    if (!belongs_to_plugin(row) || std::ranges::find(done, row.group) != done.end()) continue;
    done.push_back(row.group);
    std::string name = fmt::format("group_{}", row.group);
    std::ranges::replace(name, ' ', '_');
    maker.begin(group(std::move(name), std::string(row.group)));
    maker.add_rows(row.group);
  }
}

}  // namespace

namespace own {
std::string light_on(int light) { return fmt::format("light{}On", light); }
std::string light_position(int light) { return fmt::format("light{}Position", light); }
std::string light_value(int light) { return fmt::format("light{}Value", light); }
std::string light_colour(int light) { return fmt::format("light{}Colour", light); }
}  // namespace own

std::vector<std::string> lens_menu() { return in_order(bundled_lenses(), kLensOrder); }
std::vector<std::string> look_menu() { return in_order(params::bundled_presets(), kLookOrder); }

std::vector<ParamSpec> parameter_list(EffectContext context, bool is_display_referred) {
  ListMaker maker;
  add_lens(maker);
  maker.begin(group("groupLights", "Lights", true));
  add_lights(maker, context);
  maker.add_rows("Lights");
  add_output(maker, context, is_display_referred);
  maker.begin(group("groupLens", "Lens settings"));
  maker.add_rows("Lens");
  add_other_groups(maker);
  return maker.take();
}

}  // namespace contrejour::openfx
