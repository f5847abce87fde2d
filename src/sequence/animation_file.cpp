// SPDX-License-Identifier: Apache-2.0
// docs/formats/lights.md: a TOML file of lights and parameters, each a constant or keys by frame.
#include <algorithm>
#include <charconv>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "base/text_file.h"
#include "base/toml_fields.h"
#include "contrejour/expert/animation.h"
#include "contrejour/expert/nearest_name.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour {
namespace {

using params::Kind;
using params::Parameter;

constexpr std::string_view kPage = "docs/formats/lights.md";
constexpr std::size_t kMaxFileBytes = std::size_t{64} << 20U;  // a tracked light has a key in each frame
constexpr std::size_t kMaxLights = 10000;
constexpr NumberRange kAny{-1e15, 1e15};

std::optional<int> frame_of(std::string_view key) {
  int frame = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), frame);
  if (error != std::errc() || end != key.data() + key.size()) return std::nullopt;
  return frame;
}

// A number, a list of numbers, a text, true or false.
Key read_key(int frame, const toml::node& node, std::string_view name, TomlFields& fields) {
  Key key{frame, {}, {}};
  if (const auto* text = node.as_string()) {
    key.text = text->get();
  } else if (const auto* flag = node.as_boolean()) {
    key.text = flag->get() ? "on" : "off";
  } else if (const auto* list = node.as_array()) {
    for (const toml::node& number : *list) key.numbers.push_back(fields.number_at(number, name, kAny));
    if (list->empty()) fields.fail(node, fmt::format("{}: the list is empty", name));
  } else {
    key.numbers = {fields.number_at(node, name, kAny)};
  }
  return key;
}

Interpolation read_between(const toml::node& node, std::string_view name, TomlFields& fields) {
  const std::string between = node.value_or(std::string());
  if (between == "step") return Interpolation::Step;
  if (between == "smooth") return Interpolation::Smooth;
  if (between != "linear") fields.fail(node, fmt::format("{}: between is \"step\", \"linear\" or \"smooth\"", name));
  return Interpolation::Linear;
}

KeyedValue read_keys(const toml::table& table, std::string_view name, TomlFields& fields) {
  KeyedValue value;
  for (const auto& [key, node] : table) {
    if (key.str() == "between") {
      value.between = read_between(node, name, fields);
      continue;
    }
    const auto frame = frame_of(key.str());
    if (!frame) {
      fields.fail(node, fmt::format("{}: \"{}\" is not the number of a frame; write {{ 1001 = VALUE, 1048 = VALUE }}",
                                    name, key.str().substr(0, 40)));
      break;
    }
    value.keys.push_back(read_key(*frame, node, name, fields));
  }
  std::sort(value.keys.begin(), value.keys.end(), [](const Key& a, const Key& b) { return a.frame < b.frame; });
  for (std::size_t k = 1; k < value.keys.size(); ++k) {
    if (value.keys[k].frame == value.keys[k - 1].frame)
      fields.fail(table, fmt::format("{}: frame {} has two keys", name, value.keys[k].frame));
    if (value.keys[k].numbers.size() != value.keys[0].numbers.size())
      fields.fail(table,
                  fmt::format("{}: the keys are of different kinds; give all as a text, or all as numbers", name));
  }
  if (value.keys.empty()) fields.fail(table, fmt::format("{}: there is no key", name));
  return value;
}

// Checks a value as the command line writes it.
using ValueCheck = std::function<Result<void>(std::string_view text)>;

std::optional<KeyedValue> read_value(std::string_view name, TomlFields& fields, TomlErrors& errors,
                                     const ValueCheck& check) {
  const toml::node* node = fields.find(name);
  if (node == nullptr) return std::nullopt;
  KeyedValue value;
  if (const toml::table* table = node->as_table()) {
    value = read_keys(*table, name, fields);
  } else {
    value.keys = {read_key(0, *node, name, fields)};
  }
  for (const Key& key : value.keys) {
    if (errors.failed()) return std::nullopt;
    const KeyedValue alone{{key}, Interpolation::Step};
    if (const auto good = check(text_at(alone, key.frame)); !good)
      fields.fail(*node, fmt::format("{}: {}", name, good.error().message));
  }
  return value;
}

template <class T>
Result<void> without_value(const Result<T>& result) {
  if (!result) return tl::unexpected(result.error());
  return {};
}

Result<void> check_position(std::string_view text) { return without_value(params::parse_reals(text, 2)); }
Result<void> check_light_value(std::string_view text) { return without_value(params::parse_light_value(text)); }
Result<void> check_colour(std::string_view text) { return without_value(params::parse_light_colour(text)); }
Result<void> check_distance(std::string_view text) { return without_value(params::parse_distance_mm(text)); }
Result<void> check_size(std::string_view text) { return params::check_value(params::parameter("light-size"), text); }
Result<void> check_on(std::string_view text) {
  if (text == "on" || text == "off") return {};
  return invalid_argument("give true or false");
}

AnimatedLight read_light(const toml::table& table, std::size_t index, TomlErrors& errors) {
  TomlFields fields(table, fmt::format("light {}", index + 1),
                    {"name", "at", "direction", "value", "colour", "size", "distance", "on"}, errors);
  AnimatedLight light;
  light.name = fields.text("name").value_or(fmt::format("{}", index + 1));
  light.by_direction = fields.has("direction");
  if (light.by_direction == fields.has("at"))
    fields.fail_here(
        "give either at = [u, v], the position of the light's image, or direction = [right, up] in degrees");
  if (auto position = read_value(light.by_direction ? "direction" : "at", fields, errors, check_position))
    light.position = std::move(*position);
  light.value = read_value("value", fields, errors, check_light_value);
  light.colour = read_value("colour", fields, errors, check_colour);
  light.size_deg = read_value("size", fields, errors, check_size);
  light.distance = read_value("distance", fields, errors, check_distance);
  light.on = read_value("on", fields, errors, check_on);
  return light;
}

void read_lights(TomlFields& fields, TomlErrors& errors, Animation& animation) {
  const toml::array* rows = fields.array("light");
  if (rows == nullptr) return;
  if (rows->size() > kMaxLights) return fields.fail(*rows, fmt::format("more than {} lights", kMaxLights));
  std::set<std::string> names;
  for (const toml::node& row : *rows) {
    if (!row.is_table()) return fields.fail(row, "each light is a table: [[light]]");
    animation.lights.push_back(read_light(*row.as_table(), animation.lights.size(), errors));
    if (errors.failed()) return;
    const std::string& name = animation.lights.back().name;
    if (!names.insert(name).second) return fields.fail(row, fmt::format("two lights have the name \"{}\"", name));
  }
}

// Parameters that decide the form of the output, or which lights there are, are the same in all frames.
bool may_have_keys(const Parameter& parameter) {
  static constexpr std::string_view kFixed[] = {"size", "threads", "light", "light-at", "method", "device"};
  return !parameter.repeats && std::find(std::begin(kFixed), std::end(kFixed), parameter.name) == std::end(kFixed);
}

const Parameter* find_parameter(std::string_view name) {
  for (const Parameter& parameter : params::all_parameters())
    if (parameter.name == name) return &parameter;
  return nullptr;
}

std::string unknown_parameter(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Parameter& parameter : params::all_parameters())
    if (may_have_keys(parameter)) names.push_back(parameter.name);
  const std::string nearest = nearest_name(name, names);
  return fmt::format("\"{}\" is not a parameter that can change over a shot{}", name.substr(0, 60),
                     nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest));
}

void read_parameters(const toml::table& root, TomlErrors& errors, Animation& animation) {
  const toml::table* table = root["parameters"].as_table();
  if (table == nullptr) return;
  TomlFields fields(*table, "parameters", errors);
  for (const auto& [key, node] : *table) {
    const Parameter* parameter = find_parameter(key.str());
    if (parameter == nullptr || !may_have_keys(*parameter)) return fields.fail(node, unknown_parameter(key.str()));
    const auto check = [&](std::string_view text) { return params::check_value(*parameter, text); };
    if (auto value = read_value(key.str(), fields, errors, check))
      animation.parameters.emplace_back(key.str(), std::move(*value));
    if (errors.failed()) return;
  }
}

}  // namespace

Result<Animation> read_animation(std::string_view toml, const std::string& file) {
  const Result<toml::table> root = parse_toml(toml, file, kPage);
  if (!root) return tl::unexpected(root.error());
  TomlErrors errors(file);
  TomlFields fields(*root, "file", {"light", "parameters"}, errors);
  Animation animation;
  static_cast<void>(fields.table("parameters"));  // an error if it is no table
  read_parameters(*root, errors, animation);
  read_lights(fields, errors, animation);
  if (errors.failed()) return tl::unexpected(errors.error());
  return animation;
}

Result<Animation> read_animation(const std::filesystem::path& file) {
  const auto text = read_text_file(file, kMaxFileBytes, "name a file of lights (docs/formats/lights.md)");
  if (!text) return tl::unexpected(text.error());
  return read_animation(*text, file.string());
}

}  // namespace contrejour
