// SPDX-License-Identifier: Apache-2.0
// docs/formats/lights.md
#include <fmt/format.h>

#include "base/toml_fields.h"
#include "contrejour/expert/animation.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxKeysOfALine = 4;

// Switches are texts in memory, as on the command line.
std::string toml_of(const Key& key) {
  if (key.numbers.empty()) {
    if (key.text == "on") return "true";
    if (key.text == "off") return "false";
    return toml_string(key.text);
  }
  if (key.numbers.size() == 1) return toml_number(key.numbers.front());
  std::string list;
  for (const double number : key.numbers) list += (list.empty() ? "[" : ", ") + toml_number(number);
  return list + "]";
}

std::string_view name_of(Interpolation between) {
  return between == Interpolation::Step ? "step" : between == Interpolation::Smooth ? "smooth" : "linear";
}

// The reader gives a constant one key, at frame 0.
bool is_constant(const KeyedValue& value) {
  return value.keys.size() == 1 && value.keys.front().frame == 0 && value.between == Interpolation::Linear;
}

std::string inline_table(const KeyedValue& value) {
  std::string keys;
  for (const Key& key : value.keys) keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", key.frame, toml_of(key));
  if (value.between != Interpolation::Linear) keys += fmt::format(", between = \"{}\"", name_of(value.between));
  return "{ " + keys + " }";
}

// The values of a table. Those with tables of their own come last, since a table ends where the next begins.
class TableWriter {
 public:
  explicit TableWriter(std::string name) : name_(std::move(name)) {}

  void add(std::string_view key, const KeyedValue& value) {
    if (value.keys.size() > kMaxKeysOfALine) return add_table(key, value);
    lines_ += fmt::format("{} = {}\n", key, is_constant(value) ? toml_of(value.keys.front()) : inline_table(value));
  }
  void add(std::string_view key, const std::optional<KeyedValue>& value) {
    if (value) add(key, *value);
  }
  [[nodiscard]] std::string text() const { return lines_ + tables_; }

 private:
  void add_table(std::string_view key, const KeyedValue& value) {
    tables_ += fmt::format("\n[{}.{}]\n", name_, key);
    if (value.between != Interpolation::Linear) tables_ += fmt::format("between = \"{}\"\n", name_of(value.between));
    for (const Key& at : value.keys) tables_ += fmt::format("{} = {}\n", at.frame, toml_of(at));
  }

  std::string name_, lines_, tables_;
};

std::string text_of(const AnimatedLight& light) {
  TableWriter table("light");
  table.add(light.by_direction ? "direction" : "at", light.position);
  table.add("value", light.value);
  table.add("colour", light.colour);
  table.add("size", light.size_deg);
  table.add("distance", light.distance);
  table.add("on", light.on);
  return fmt::format("[[light]]\nname = {}\n{}", toml_string(light.name), table.text());
}

}  // namespace

std::string write_animation(const Animation& animation) {
  std::string text;
  if (!animation.parameters.empty()) {
    TableWriter table("parameters");
    for (const auto& [name, value] : animation.parameters) table.add(name, value);
    text = "[parameters]\n" + table.text();
  }
  for (const AnimatedLight& light : animation.lights) text += (text.empty() ? "" : "\n") + text_of(light);
  return text;
}

}  // namespace contrejour
