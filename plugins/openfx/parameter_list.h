// SPDX-License-Identifier: Apache-2.0
// Every parameter of the plug-in: those of the library's table (parameter.h), and the plug-in's own, which say what the
// command line says by its arguments. Describing, reading and the look's button go through this one list, so a row
// that is added to the library's table appears in every host.
// Thread-safety: constant data and pure functions.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/parameter.h"

namespace contrejour::openfx {

enum class ParamType { Real, Integer, Boolean, Choice, Text, File, Position, Colour, Button, Group };

struct ParamSpec {
  std::string name;  // the script name, which projects store: ASCII, never renamed
  std::string label, hint;
  std::string group;  // the name of its group; empty: none
  ParamType type = ParamType::Real;
  double minimum = 0.0, maximum = 0.0;
  double display_minimum = 0.0, display_maximum = 0.0;  // what a slider spans
  std::vector<double> fallback = {};  // one number, two of a position, three of a colour
  std::string text = {};  // default of a text
  std::vector<std::string> choices = {};  // by which some hosts store a choice, others by its index: only ever appended
  const params::Parameter* row = nullptr;  // of the library's table; null: the plug-in's own
  bool first_choice_is_automatic = false;  // a row without a default has one choice more, in front
  bool open = false;  // a group that is shown open
};

enum class EffectContext { Filter, General, Generator };

// Groups precede their members. is_display_referred: whether the host's pixels are usually coded for a display.
[[nodiscard]] std::vector<ParamSpec> parameter_list(EffectContext context, bool is_display_referred);

// The rows of the library's table that a plug-in has no use for: a host's clip has a size and a pixel aspect, shows the
// picture itself, and no ghost is drawn in a single wavelength.
[[nodiscard]] bool belongs_to_plugin(const params::Parameter& row);
[[nodiscard]] ParamSpec spec_of_row(const params::Parameter& row);

// The names of the plug-in's own parameters.
namespace own {
inline constexpr const char *kLook = "look", *kLookFile = "lookFile", *kLoadLook = "loadLook", *kLens = "lens",
                            *kLensFile = "lensFile", *kLightsFile = "lightsFile", *kOutput = "output",
                            *kAlpha = "alpha", *kTransfer = "transfer", *kFrame = "sensorFrame", *kDraft = "draft";
// Lights count from 1: "light1On".
inline constexpr int kLights = 4;
[[nodiscard]] std::string light_on(int light);
[[nodiscard]] std::string light_position(int light);
[[nodiscard]] std::string light_value(int light);
[[nodiscard]] std::string light_colour(int light);
}  // namespace own

// Which picture the plug-in gives, in the order of the menu.
enum class OutputPicture { SourceAndFlare, Flare, DetectedLights };
enum class OutputAlpha { Source, Zero, Flare };
enum class SensorFrame { Project, Source };

// The bundled lenses and presets in the order of their menus.
[[nodiscard]] std::vector<std::string> lens_menu();
[[nodiscard]] std::vector<std::string> look_menu();
inline constexpr const char* kDefaultLens = "heliar";

}  // namespace contrejour::openfx
