// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace contrejour::cli {
namespace {

using params::Kind;
using params::Parameter;

std::string option_flags(const Parameter& p) {
  return p.letter != '\0' ? fmt::format("-{},--{}", p.letter, p.name) : fmt::format("--{}", p.name);
}

// The placeholder for the value in the help.
std::string placeholder(const Parameter& p) {
  if (p.kind == Kind::Choice) return fmt::format("{}", fmt::join(p.choices, "|"));
  if (p.unit.empty()) return p.kind == Kind::Integer ? "N" : "NUMBER";
  std::string text(p.unit);
  if (p.kind != Kind::Text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  }
  return text;
}

std::string help_of(const Parameter& p) {
  return p.fallback.empty() ? std::string(p.help) : fmt::format("{} (default: {})", p.help, p.fallback);
}

// A switch. The negative form is for use with a preset that switches the parameter on.
CLI::Option* add_switch(CLI::App& command, params::Values& values, const Parameter& p, std::string_view name) {
  return command.add_flag_function(
      fmt::format("--{0},!--no-{0}", name),
      [&values, &p](std::int64_t n) { static_cast<void>(values.set(p.name, n > 0 ? "on" : "off")); }, help_of(p));
}

CLI::Option* add_value(CLI::App& command, params::Values& values, const Parameter& p, const std::string& flags) {
  const auto set_all = [&values, &p](const CLI::results_t& texts) {
    for (const std::string& text : texts) {
      const auto checked = values.set(p.name, text);
      if (!checked) throw CLI::ValidationError(fmt::format("--{}", p.name), checked.error().to_string());
    }
    return true;
  };
  CLI::Option* option = command.add_option(flags, set_all, help_of(p));
  option->type_size(1)->expected(1)->option_text(placeholder(p));
  if (p.repeats) option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  return option;
}

// Adds the parameter, and its former name as an option that the help does not show.
void add_parameter(CLI::App& command, params::Values& values, const Parameter& p) {
  const bool is_switch = p.kind == Kind::Switch;
  CLI::Option* option =
      is_switch ? add_switch(command, values, p, p.name) : add_value(command, values, p, option_flags(p));
  option->group(std::string(p.group));
  if (p.former.empty()) return;
  option = is_switch ? add_switch(command, values, p, p.former)
                     : add_value(command, values, p, fmt::format("--{}", p.former));
  option->group("");
}

}  // namespace

void add_parameters(CLI::App& command, params::Values& values, std::initializer_list<std::string_view> names) {
  add_parameters(command, values, std::span(names.begin(), names.size()));
}

void add_parameters(CLI::App& command, params::Values& values, std::span<const std::string_view> names) {
  for (const std::string_view name : names) add_parameter(command, values, params::parameter(name));
}

void add_others_of_group(CLI::App& command, params::Values& values, std::string_view group, std::string_view except) {
  for (const Parameter& p : params::all_parameters())
    if (p.group == group && p.name != except && command.get_option_no_throw(fmt::format("--{}", p.name)) == nullptr)
      add_parameter(command, values, p);
}

void add_lens_parameters(CLI::App& command, params::Values& values) {
  add_parameters(command, values, {"focal", "fnumber", "focus", "coating", "coating-at"});
  add_parameters(command, values, kIris);
  add_parameters(command, values, {"blade-closing", "tilt", "decentre", "build-seed", "absorption"});
  add_parameters(command, values, {"sensor", "cover-glass", "sensor-reflectance"});
  add_parameters(command, values, kGrating);
  add_parameters(command, values, kDirt);
  add_others_of_group(command, values, "Lens", "wavelength");
}

void hide_parameters(CLI::App& command, std::span<const std::string_view> names) {
  for (const std::string_view name : names) command.get_option("--" + std::string(name))->group("");
}

void add_rendering_parameters(CLI::App& command, params::Values& values) {
  add_parameters(command, values,
                 {"method", "device", "wavelengths", "colour-space", "ghosts", "reflections", "select", "threads"});
  add_parameters(command, values, {"grid", "scale-grid", "scale-grid-sigma", "scale-grid-phi"});
  add_parameters(
      command, values,
      {"grid-levels", "mirror-symmetry", "precomputed-pupils", "spectral-filter", "flat-shading", "anisotropic"});
  add_parameters(command, values, {"merge-steps", "merge-threshold", "tile", "coarse-tile", "interpolation"});
  add_parameters(command, values, {"error", "density"});
  add_parameters(command, values, {"starburst", "starburst-gain", "glare", "glare-width"});
  add_parameters(command, values, {"ringing", "ringing-alpha"});
  add_parameters(command, values,
                 {"ghost", "ghost-gain", "ghost-edge-gain", "ghost-ramp", "ghost-jitter", "ghost-seed"});
  add_others_of_group(command, values, "Rendering");
}

void add_picture_choice(CLI::App& command, ReadOptions& read) {
  command
      .add_option("--layer", read.layer,
                  "the layer of the EXR to read: NAME.R, NAME.G, NAME.B, or the part of this name")
      ->option_text("NAME");
  command.add_option("--part", read.part, "the part of the EXR to read, by its name or its number from 0")
      ->option_text("NAME|N");
}

void add_plate_colour(CLI::App& command, PlateColour& colour, PlateUse use) {
  constexpr const char* kGroup = "Colour spaces";
  if (use != PlateUse::Write)
    command
        .add_option("--input-space", colour.input_space,
                    "the colour space of the picture's values, by its name in the OpenColorIO configuration "
                    "(default: linear for floats, sRGB for integers)")
        ->option_text("NAME")
        ->group(kGroup);
  if (use != PlateUse::Read)
    command
        .add_option("--output-space", colour.output_space,
                    use == PlateUse::Write ? "the colour space to write, by its name in the OpenColorIO configuration "
                                             "(default: linear for floats, sRGB for integers)"
                                           : "the colour space to write (default: the input's in the same format)")
        ->option_text("NAME")
        ->group(kGroup);
  command
      .add_option("--ocio-config", colour.config,
                  "the OpenColorIO configuration (default: $OCIO, or the ACES spaces and camera logs that "
                  "OpenColorIO has)")
      ->option_text("FILE")
      ->group(kGroup);
}

CLI::Option* add_number(CLI::App& command, const std::string& flag, int& number, int min, int max,
                        const std::string& help) {
  return command.add_option(flag, number, fmt::format("{} (default: {})", help, number))
      ->check(CLI::Range(min, max))
      ->option_text("N");
}

namespace {

const std::map<std::string, ExrCompression>& compressions() {
  static const std::map<std::string, ExrCompression> by_name{{"none", ExrCompression::None},
                                                             {"rle", ExrCompression::Rle},
                                                             {"zips", ExrCompression::Zips},
                                                             {"zip", ExrCompression::Zip},
                                                             {"piz", ExrCompression::Piz}};
  return by_name;
}

}  // namespace

void add_exr_compression(CLI::App& command, ExrCompression& compression) {
  command
      .add_option_function<std::string>(
          "--compression", [&compression](const std::string& name) { compression = compressions().at(name); },
          "the lossless compression of EXR files; none and rle take a fraction of the time of the others "
          "(default: that of the picture read, else zip)")
      ->check(CLI::IsMember({"none", "rle", "zips", "zip", "piz"}))
      ->option_text("none|rle|zips|zip|piz");
}

std::string compression_text(ExrCompression compression) {
  for (const auto& [name, value] : compressions())
    if (value == compression) return fmt::format("compression = {}\n", name);
  return {};
}

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

CLI::Option* add_output(CLI::App& command, const std::string& flags, std::string& file,
                        std::initializer_list<std::string_view> endings, const std::string& help) {
  const std::vector<std::string> allowed(endings.begin(), endings.end());
  const auto check = [allowed](const std::string& name) {
    if (std::find(allowed.begin(), allowed.end(), lower_extension(name)) != allowed.end()) return std::string();
    return fmt::format("\"{}\" has no known extension; give a name that ends in {}", name, fmt::join(allowed, " or "));
  };
  return command.add_option(flags, file, help)->check(CLI::Validator(check, "", "extension"))->option_text("FILE");
}

}  // namespace contrejour::cli
