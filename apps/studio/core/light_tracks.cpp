// SPDX-License-Identifier: Apache-2.0
#include "studio/core/light_tracks.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "studio/core/lights.h"

namespace contrejour::studio {
namespace {

using LightEntries = std::vector<LightEntry>;

constexpr std::array kAllParts = {LightPart::Position, LightPart::Value, LightPart::Colour, LightPart::Size,
                                  LightPart::Distance};

std::string text_of_part(const LightEntry& light, LightPart part) {
  switch (part) {
    case LightPart::Position: return fmt::format("{},{}", light.at.x, light.at.y);
    case LightPart::Value: return light.value;
    case LightPart::Colour: return light.colour;
    case LightPart::Size: return light.size;
    case LightPart::Distance: return light.distance;
  }
  return {};
}

// Numbers where the text is nothing else: "2m" and "3200K" remain texts.
Key key_of_part(const LightEntry& light, LightPart part, int frame) {
  if (part == LightPart::Position) return {frame, {light.at.x, light.at.y}, {}};
  const std::string text = text_of_part(light, part);
  std::vector<double> numbers;
  for (const std::string_view one : params::split(text, ',')) {
    const auto number = params::parse_real(one);
    if (!number) return {frame, {}, text};
    numbers.push_back(*number);
  }
  return {frame, std::move(numbers), {}};
}

std::optional<KeyedValue>& optional_track(AnimatedLight& light, LightPart part) {
  if (part == LightPart::Value) return light.value;
  if (part == LightPart::Colour) return light.colour;
  return part == LightPart::Size ? light.size_deg : light.distance;
}

AnimatedLight constant_light(const LightEntry& entry, std::string name) {
  AnimatedLight light;
  light.name = std::move(name);
  for (const LightPart part : kAllParts)
    if (!text_of_part(entry, part).empty())
      set_light_track(light, part, {{key_of_part(entry, part, 0)}, Interpolation::Linear});
  return light;
}

std::string new_name(const std::vector<AnimatedLight>& lights) {
  std::set<std::string> names;
  for (const AnimatedLight& light : lights) names.insert(light.name);
  for (std::size_t k = lights.size() + 1;; ++k)
    if (const std::string name = std::to_string(k); !names.contains(name)) return name;
}

void follow_part(AnimatedLight& light, LightPart part, const LightEntry& entry, int frame) {
  KeyedValue* value = light_track(light, part);
  const bool is_common = part != LightPart::Position && text_of_part(entry, part).empty();
  if (is_common) {
    optional_track(light, part).reset();
    return;
  }
  const Key key = key_of_part(entry, part, frame);
  if (value == nullptr || is_constant(*value) || value->keys.front().numbers.size() != key.numbers.size()) {
    Key constant = key;
    constant.frame = 0;
    set_light_track(light, part, {{constant}, Interpolation::Linear});
  } else {
    insert_key(*value, key);
  }
}

// The light that is missing in `fewer`.
std::size_t removed_light(const LightEntries& all, const LightEntries& fewer) {
  std::size_t k = 0;
  while (k < fewer.size() && all[k] == fewer[k]) ++k;
  return k;
}

std::string text_at_frame(AnimatedLight& light, LightPart part, double frame) {
  const KeyedValue* value = light_track(light, part);
  return value != nullptr ? text_at(*value, frame) : std::string();
}

std::string light_text_at(AnimatedLight light, double frame) {
  const bool is_off = light.on && text_at(*light.on, frame) == "off";
  std::string text = text_at_frame(light, LightPart::Position, frame);
  text += ":" + (is_off ? "0" : text_at_frame(light, LightPart::Value, frame));
  for (const LightPart part : {LightPart::Colour, LightPart::Size, LightPart::Distance})
    text += ":" + text_at_frame(light, part, frame);
  text.erase(text.find_last_not_of(':') + 1);
  return text;
}

}  // namespace

bool is_constant(const KeyedValue& value) {
  return value.keys.size() == 1 && value.keys.front().frame == 0 && value.between == Interpolation::Linear;
}

void insert_key(KeyedValue& value, const Key& key) {
  const auto at =
      std::find_if(value.keys.begin(), value.keys.end(), [&](const Key& k) { return k.frame >= key.frame; });
  if (at != value.keys.end() && at->frame == key.frame)
    *at = key;
  else
    value.keys.insert(at, key);
}

KeyedValue* light_track(AnimatedLight& light, LightPart part) {
  if (part == LightPart::Position) return &light.position;
  auto& value = optional_track(light, part);
  return value ? &*value : nullptr;
}

void set_light_track(AnimatedLight& light, LightPart part, const KeyedValue& value) {
  if (part == LightPart::Position)
    light.position = value;
  else
    optional_track(light, part) = value;
}

Result<Key> key_of_light(const Document& document, std::size_t light, LightPart part, int frame) {
  const auto lights = lights_of(document);
  if (light >= lights.size()) return invalid_argument("there is no such light");
  if (part != LightPart::Position && text_of_part(lights[light], part).empty())
    return invalid_argument(
        fmt::format("give light {} a {} of its own first; then it can have keys", light + 1, name_of(part)));
  return key_of_part(lights[light], part, frame);
}

Document with_animated_lights(Document document) {
  if (!document.animation.lights.empty()) return document;
  for (const LightEntry& entry : lights_of(document))
    document.animation.lights.push_back(constant_light(entry, new_name(document.animation.lights)));
  return document;
}

Document with_lights_at(Document document, double frame) {
  if (document.animation.lights.empty()) return document;
  document.texts.erase("light");
  document.texts.erase("light-at");
  for (const AnimatedLight& light : document.animation.lights)
    document.texts[light.by_direction ? "light" : "light-at"].push_back(light_text_at(light, frame));
  return document;
}

Document with_light_edits(const Document& before, Document after, int frame) {
  auto& animated = after.animation.lights;
  const LightEntries was = lights_of(before), is = lights_of(after);
  if (animated.empty() || was == is) return after;
  if (is.size() < was.size() && is.size() + 1 == animated.size()) {
    animated.erase(animated.begin() + static_cast<std::ptrdiff_t>(removed_light(was, is)));
    return after;
  }
  if (is.size() < animated.size()) {  // other lights altogether
    animated.clear();
    return with_animated_lights(std::move(after));
  }
  for (std::size_t k = 0; k < is.size(); ++k) {
    if (k >= animated.size()) {
      animated.push_back(constant_light(is[k], new_name(animated)));
      continue;
    }
    for (const LightPart part : kAllParts)
      if (k >= was.size() || text_of_part(was[k], part) != text_of_part(is[k], part))
        follow_part(animated[k], part, is[k], frame);
  }
  return after;
}

}  // namespace contrejour::studio
