// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/animation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "sequence/keyed_value.h"

namespace contrejour {
namespace {

using params::Kind;
using params::Parameter;

// "A,B:VALUE:COLOUR:SIZE:DISTANCE", without the parts that are missing at its end.
std::string light_text(const AnimatedLight& light, double frame) {
  std::string text = text_at(light.position, frame);
  for (const std::optional<KeyedValue>* part : {&light.value, &light.colour, &light.size_deg, &light.distance})
    text += part->has_value() ? ":" + text_at(**part, frame) : ":";
  text.erase(text.find_last_not_of(':') + 1);
  return text;
}

std::string parameter_text(const Parameter& parameter, const KeyedValue& value, double frame) {
  if (parameter.kind == Kind::Integer && !value.keys.front().numbers.empty())
    return fmt::format("{:.0f}", std::round(numbers_at(value, frame).front()));
  return text_at(value, frame);
}

std::vector<const KeyedValue*> all_values(const Animation& animation) {
  std::vector<const KeyedValue*> all;
  for (const auto& [name, value] : animation.parameters) all.push_back(&value);
  for (const AnimatedLight& light : animation.lights) {
    all.push_back(&light.position);
    for (const auto* part : {&light.value, &light.colour, &light.size_deg, &light.distance, &light.on})
      if (part->has_value()) all.push_back(&**part);
  }
  return all;
}

}  // namespace

// The reader has checked every value.
params::Values parameters_at(const Animation& animation, double frame) {
  params::Values values;
  for (const auto& [name, value] : animation.parameters)
    static_cast<void>(values.set(name, parameter_text(params::parameter(name), value, frame)));
  return values;
}

void add_lights_at(const Animation& animation, double frame, params::Values& values) {
  for (const AnimatedLight& light : animation.lights) {
    if (light.on && text_at(*light.on, frame) == "off") continue;
    static_cast<void>(values.set(light.by_direction ? "light" : "light-at", light_text(light, frame)));
  }
}

int first_key(const Animation& animation) {
  int first = std::numeric_limits<int>::max();
  for (const KeyedValue* value : all_values(animation))
    if (value->keys.size() > 1) first = std::min(first, value->keys.front().frame);
  return first == std::numeric_limits<int>::max() ? 0 : first;
}

}  // namespace contrejour
