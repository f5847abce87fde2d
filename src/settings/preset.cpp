// SPDX-License-Identifier: Apache-2.0
#include "contrejour/preset.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/key_values.h"
#include "contrejour/expert/nearest_name.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {
namespace {

constexpr std::string_view kPage = "docs/formats/preset.md";

// The presets in alphabetical order; the file is written by embed_text.cmake when the program is built.
constexpr BundledPreset kBundled[] = {
#include "bundled_presets.inc"
};

bool is_called(const Parameter& p, std::string_view key) { return p.name == key || (p.former == key && !key.empty()); }

std::vector<std::string_view> known_keys() {
  std::vector<std::string_view> keys{"name", "description", "lens"};
  for (const Parameter& p : all_parameters()) {
    if (belongs_to_preset(p)) keys.push_back(p.name);
  }
  return keys;
}

Error unknown_key(const KeyValue& given) {
  for (const Parameter& p : all_parameters()) {
    if (!is_called(p, given.key)) continue;
    return {
        ErrorCode::Parse,
        fmt::format("{} describes a scene and is not part of a preset; give --{} on the command line", p.name, p.name),
        given.position};
  }
  const std::string nearest = nearest_name(given.key, known_keys());
  const std::string remedy = nearest.empty() ? fmt::format("see {}", kPage) : fmt::format("did you mean {}?", nearest);
  return {ErrorCode::Parse, fmt::format("\"{}\" is not a key of a preset; {}", given.key.substr(0, 60), remedy),
          given.position};
}

std::string* heading(Preset& preset, std::string_view key) {
  if (key == "name") return &preset.name;
  if (key == "description") return &preset.description;
  if (key == "lens") return &preset.lens;
  return nullptr;
}

Result<void> set_key(Preset& preset, const KeyValue& given) {
  const auto wrong = [&](std::string_view what) {
    return failure(ErrorCode::Parse, fmt::format("{}: {}", given.key, what), given.position);
  };
  if (std::string* text = heading(preset, given.key)) {
    if (given.kind != KeyValue::Kind::Text) return wrong("the value is not text; write it in quotes");
    *text = given.texts.front();
    return {};
  }
  const auto all = all_parameters();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Parameter& p) { return is_called(p, given.key) && belongs_to_preset(p); });
  if (found == all.end()) return tl::unexpected(unknown_key(given));
  if (preset.values.given(found->name))
    return wrong(fmt::format("{} is the earlier name of {}; give only the latter", found->former, found->name));
  if (found->kind == Kind::Switch) {
    if (given.kind != KeyValue::Kind::Boolean) return wrong("the value of a switch is true or false");
    return preset.values.set(found->name, given.texts.front() == "true" ? "on" : "off");
  }
  if (given.kind == KeyValue::Kind::Boolean) return wrong("this is not a switch; give a value, not true or false");
  if (given.kind == KeyValue::Kind::TextList && !found->repeats)
    return wrong("this has a single value; give one, not a list");
  for (const std::string& text : given.texts) {
    if (const auto ok = preset.values.set(found->name, text); !ok) return wrong(ok.error().message);
  }
  return {};
}

Result<Preset> preset_of(const Result<std::vector<KeyValue>>& given) {
  if (!given) return tl::unexpected(given.error());
  Preset preset;
  for (const KeyValue& value : *given) {
    if (const auto ok = set_key(preset, value); !ok) return tl::unexpected(ok.error());
  }
  return preset;
}

KeyValue::Kind kind_of(const Parameter& p) {
  if (p.repeats) return KeyValue::Kind::TextList;
  if (p.kind == Kind::Switch) return KeyValue::Kind::Boolean;
  return p.kind == Kind::Real || p.kind == Kind::Integer ? KeyValue::Kind::Number : KeyValue::Kind::Text;
}

// A number in the form that TOML requires: the command line also accepts ".5", "+5" and "08", which TOML does not.
std::string number_text(const Parameter& p, const std::string& given) {
  return p.kind == Kind::Integer ? fmt::format("{}", *parse_integer(given)) : fmt::format("{}", *parse_real(given));
}

}  // namespace

bool belongs_to_preset(const Parameter& parameter) { return !parameter.scene; }

Result<Preset> read_preset(std::string_view toml, const std::string& file) {
  return preset_of(read_key_values(toml, file, kPage));
}

std::string write_preset(const Preset& preset) {
  std::vector<KeyValue> out;
  const auto add_heading = [&](std::string key, const std::string& text) {
    if (!text.empty()) out.push_back({std::move(key), KeyValue::Kind::Text, {text}});
  };
  add_heading("name", preset.name);
  add_heading("description", preset.description);
  add_heading("lens", preset.lens);
  for (const Parameter& p : all_parameters()) {
    if (!belongs_to_preset(p)) continue;
    KeyValue value{std::string(p.name), kind_of(p), {}};
    if (p.repeats) {
      value.texts = preset.values.list(p.name);
    } else if (p.kind == Kind::Switch) {
      value.texts = {preset.values.is_on(p.name) ? "true" : "false"};
    } else if (const auto text = preset.values.text(p.name)) {
      value.texts = {value.kind == KeyValue::Kind::Number ? number_text(p, *text) : *text};
    }
    if (!value.texts.empty()) out.push_back(std::move(value));
  }
  return write_key_values(out);
}

std::vector<BundledPreset> bundled_presets() { return {std::begin(kBundled), std::end(kBundled)}; }

Result<Preset> find_preset(const std::string& name_or_file) {
  std::vector<std::string_view> names;
  for (const BundledPreset& preset : kBundled) {
    if (preset.name == name_or_file) return read_preset(preset.toml, std::string(preset.name) + ".toml");
    names.push_back(preset.name);
  }
  std::error_code code;
  const std::filesystem::path path(name_or_file);
  if (path.has_parent_path() || path.has_extension() || std::filesystem::exists(path, code)) {
    return preset_of(read_key_values(path, kPage));
  }
  const std::string nearest = nearest_name(name_or_file, names);
  const std::string remedy = nearest.empty()
                                 ? fmt::format("give a file or one of {}", fmt::join(names, ", "))
                                 : fmt::format("did you mean {}? `contrejour preset list` lists the presets", nearest);
  return invalid_argument(
      fmt::format("no preset and no file has the name \"{}\"; {}", name_or_file.substr(0, 60), remedy));
}

}  // namespace contrejour::params
