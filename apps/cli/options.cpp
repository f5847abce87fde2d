// SPDX-License-Identifier: Apache-2.0
#include "cli/options.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace contrejour::cli {
namespace {

using params::Kind;
using params::Parameter;

std::string flags_of(const Parameter& p) {
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

void add_parameter(CLI::App& command, params::Values& values, const Parameter& p) {
  const std::string name(p.name);
  const auto set = [&values, name](const std::string& text) {
    const auto checked = values.set(name, text);
    if (!checked) throw CLI::ValidationError("--" + name, checked.error().to_string());
  };
  if (p.kind == Kind::Switch) {
    // The negative form is for use with a preset that switches the parameter on.
    command
        .add_flag_function(
            fmt::format("--{0},!--no-{0}", p.name), [set](std::int64_t n) { set(n > 0 ? "on" : "off"); }, help_of(p))
        ->group(std::string(p.group));
    return;
  }
  CLI::Option* option = command.add_option(
      flags_of(p),
      [set](const CLI::results_t& texts) {
        for (const std::string& text : texts) set(text);
        return true;
      },
      help_of(p));
  option->type_size(1)->expected(1)->option_text(placeholder(p))->group(std::string(p.group));
  if (p.repeats) option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_parameters(CLI::App& command, params::Values& values, std::initializer_list<std::string_view> names) {
  add_parameters(command, values, std::span(names.begin(), names.size()));
}

void add_parameters(CLI::App& command, params::Values& values, std::span<const std::string_view> names) {
  for (const std::string_view name : names) add_parameter(command, values, params::parameter(name));
}

void add_lens_parameters(CLI::App& command, params::Values& values) {
  add_parameters(command, values, {"focal", "fnumber", "focus", "coating", "coating-at"});
  add_parameters(command, values, kIris);
  add_parameters(command, values, {"blade-closing", "tilt", "decentre", "build-seed", "absorption"});
  add_parameters(command, values, {"sensor", "cover-glass", "sensor-reflectance"});
  add_parameters(command, values, kGrating);
  add_parameters(command, values, kDirt);
}

void hide_parameters(CLI::App& command, std::span<const std::string_view> names) {
  for (const std::string_view name : names) command.get_option("--" + std::string(name))->group("");
}

void add_rendering_parameters(CLI::App& command, params::Values& values) {
  add_parameters(command, values,
                 {"method", "device", "wavelengths", "colour-space", "ghosts", "reflections", "select", "threads"});
  add_parameters(command, values, {"grid", "scale-grid", "scale-grid-sigma", "scale-grid-phi"});
  add_parameters(command, values,
                 {"grid-levels", "mirror", "pupil-table", "spectral-filter", "flat-shading", "anisotropic"});
  add_parameters(command, values, {"merge-steps", "merge-threshold", "tile", "coarse-tile", "interpolation"});
  add_parameters(command, values, {"error", "density"});
  add_parameters(command, values, {"starburst", "starburst-gain", "glare", "glare-width"});
  add_parameters(command, values, {"ringing", "ringing-alpha"});
  add_parameters(command, values,
                 {"ghost", "ghost-gain", "ghost-edge-gain", "ghost-ramp", "ghost-scatter", "ghost-seed"});
}

void add_picture_choice(CLI::App& command, ReadOptions& read) {
  command.add_option("--layer", read.layer, "the EXR's layer NAME.R, NAME.G, NAME.B, or its part of that name")
      ->option_text("NAME");
  command.add_option("--part", read.part, "a part of an EXR, by its name or its number from 0")->option_text("NAME|N");
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
    return fmt::format("\"{}\" does not end in {}", name, fmt::join(allowed, " or "));
  };
  return command.add_option(flags, file, help)->check(CLI::Validator(check, "", "ending"))->option_text("FILE");
}

}  // namespace contrejour::cli
