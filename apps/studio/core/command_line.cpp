// SPDX-License-Identifier: Apache-2.0
#include "studio/core/command_line.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "studio/core/plate_frames.h"

namespace contrejour::studio {
namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("-_./,:=@+%").find(c) != std::string_view::npos;
}

// As a POSIX shell reads it.
std::string quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string out = "'";
  for (const char c : word) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

std::string option_of(const params::Parameter& p, const std::string& text) {
  const std::string name(p.name);
  if (p.kind == params::Kind::Switch) return text == "on" ? " --" + name : " --no-" + name;
  return " --" + name + (text.starts_with("-") ? "=" : " ") + quoted(text);
}

// `render` finds no lights in a picture; `apply` has the plate's size.
bool takes(bool applies, const params::Parameter& p) {
  return applies ? p.name != "size" : p.group != "Light detection";
}

const char* name_of(LayersBy by) {
  static constexpr const char* names[] = {"light", "ghost", "part", "surface"};
  return names[static_cast<std::size_t>(by)];
}

// A sequence by its pattern where all frames are meant, else by the file of the one at hand.
std::string plate_options(const SessionPlate& given, const CommandChoice& choice) {
  const SessionPlate plate = choice.kind == ExportKind::Frames ? given : plate_at(given, choice.frame);
  std::string text = " " + quoted(plate.file);
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) text += std::string(" --") + option + " " + quoted(value);
  };
  add("layer", plate.layer);
  add("part", plate.part);
  add("input-space", plate.input_space);
  add("ocio-config", plate.config);
  return text;
}

// The options that the kind of export adds, and the output.
std::string output_options(const CommandChoice& choice, bool applies) {
  const std::string output = quoted(choice.output);
  switch (choice.kind) {
    case ExportKind::Layers:
      return fmt::format(" --layers {} {} {}", name_of(choice.layers_by), applies ? "-o out.exr --flare-only" : "-o",
                         output);
    case ExportKind::Frames:
      return fmt::format(" --frames {}-{}{} -o {}", choice.first, choice.last,
                         choice.skips_missing ? " --missing skip" : "", output);
    case ExportKind::Look: return fmt::format(" --save-preset {} -o flare.exr", output);
    default: return " -o " + output;
  }
}

}  // namespace

std::string command_of_session(const Document& document, const std::string& file, const CommandChoice& choice) {
  if (choice.kind == ExportKind::Report) return "";
  if (choice.kind == ExportKind::Lens) return "contrejour lens convert " + quoted(file) + " " + quoted(choice.output);
  const bool applies = document.has_plate();
  // One frame of a sequence is named: the session's plate is all of them.
  const bool is_of_sequence = choice.kind != ExportKind::Frames && is_plate_sequence(document.plate.file);
  return fmt::format("contrejour {} --session {}", applies ? "apply" : "render", quoted(file)) +
         (is_of_sequence ? plate_options(document.plate, choice) : "") + output_options(choice, applies);
}

std::string command_of_values(const Document& document, const CommandChoice& choice) {
  const bool is_of_session = document.lens_was_edited || document.animation != Animation{};
  const bool is_of_frames = choice.kind == ExportKind::Frames && !is_plate_sequence(document.plate.file);
  if (is_of_session || choice.kind == ExportKind::Report || is_of_frames) return "";
  if (choice.kind == ExportKind::Lens)
    return "contrejour lens convert " + quoted(document.lens_name) + " " + quoted(choice.output);
  const bool applies = document.has_plate();
  std::string command = fmt::format("contrejour {} {}", applies ? "apply" : "render", quoted(document.lens_name));
  if (applies) command += plate_options(document.plate, choice);
  for (const auto& [name, texts] : document.texts)
    for (const std::string& text : texts)
      if (takes(applies, params::parameter(name))) command += option_of(params::parameter(name), text);
  return command + output_options(choice, applies);
}

}  // namespace contrejour::studio
