// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/animation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sequence/keyed_value.h"

namespace contrejour {
namespace {

using params::Kind;
using params::Parameter;

constexpr int kPathPositions = 9;  // odd, so that one is in the middle

// Evenly spaced times of a part of the exposure; one if it lasts for no time.
std::vector<double> exposure_times(double frame, Shutter shutter, ExposurePart part) {
  if (!(shutter.angle_deg > 0.0 && part.to > part.from)) return {time_of_exposure(frame, shutter, part.from)};
  std::vector<double> times;
  for (int k = 0; k < kPathPositions; ++k)
    times.push_back(time_of_exposure(frame, shutter, std::lerp(part.from, part.to, k / (kPathPositions - 1.0))));
  return times;
}

// "A,B/A,B/...", or one position where it does not move.
std::string path_text(const KeyedValue& position, std::span<const double> times) {
  std::vector<std::string> path;
  for (const double time : times) path.push_back(text_at(position, time));
  if (std::all_of(path.begin(), path.end(), [&](const std::string& at) { return at == path.front(); }))
    return path.front();
  return fmt::format("{}", fmt::join(path, "/"));
}

// The mean over evenly spaced times, by the trapezoidal rule; a text is that of the middle.
std::string mean_text(const KeyedValue& value, std::span<const double> times) {
  if (value.keys.front().numbers.empty() || times.size() == 1) return text_at(value, times[times.size() / 2]);
  std::vector<double> mean(value.keys.front().numbers.size());
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double weight = (k == 0 || k + 1 == times.size() ? 0.5 : 1.0) / static_cast<double>(times.size() - 1);
    const std::vector<double> numbers = numbers_at(value, times[k]);
    for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += weight * numbers[c];
  }
  return fmt::format("{}", fmt::join(mean, ","));
}

// "A,B:VALUE:COLOUR:SIZE:DISTANCE", without the parts that are missing at its end.
std::string light_text(const AnimatedLight& light, std::span<const double> times) {
  std::string text = path_text(light.position, times);
  text += light.value ? ":" + mean_text(*light.value, times) : ":";
  for (const std::optional<KeyedValue>* part : {&light.colour, &light.size_deg, &light.distance})
    text += part->has_value() ? ":" + text_at(**part, times[times.size() / 2]) : ":";
  text.erase(text.find_last_not_of(':') + 1);
  return text;
}

std::string parameter_text(const Parameter& parameter, const KeyedValue& value, double frame) {
  if (parameter.kind == Kind::Integer && !value.keys.front().numbers.empty())
    return fmt::format("{:.0f}", std::round(numbers_at(value, frame).front()));
  return text_at(value, frame);
}

// Whether it can be blurred: a number between two keys, for the frame's picture itself.
bool changes_gradually(const Parameter& parameter, const KeyedValue& value) {
  if (value.keys.front().numbers.empty() || value.between == Interpolation::Step) return false;
  const bool finds_lights = parameter.scene && parameter.group == "Light detection";
  if (parameter.kind == Kind::Integer || finds_lights) return false;
  return parameter.name != "shutter-angle" && parameter.name != "exposure";
}

bool is_on(const AnimatedLight& light, double frame) { return !light.on || text_at(*light.on, frame) != "off"; }

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

double time_of_exposure(double frame, Shutter shutter, double fraction) {
  const double open = shutter.angle_deg / 360.0;
  return (shutter.centred ? frame - 0.5 * open : frame) + open * fraction;
}

params::Values parameters_during(const Animation& animation, double frame, double time) {
  params::Values values;
  for (const auto& [name, value] : animation.parameters) {
    const Parameter& parameter = params::parameter(name);
    const double at = changes_gradually(parameter, value) ? time : frame;
    static_cast<void>(values.set(name, parameter_text(parameter, value, at)));
  }
  return values;
}

bool do_lights_move(const Animation& animation, double frame, Shutter shutter) {
  const std::vector<double> times = exposure_times(frame, shutter, {});
  return std::ranges::any_of(animation.lights, [&](const AnimatedLight& light) {
    return is_on(light, frame) && path_text(light.position, times).find('/') != std::string::npos;
  });
}

std::vector<std::string> names_of_lights_at(const Animation& animation, double frame, bool by_direction) {
  std::vector<std::string> names;
  for (const AnimatedLight& light : animation.lights)
    if (light.by_direction == by_direction && is_on(light, frame)) names.push_back(light.name);
  return names;
}

void add_lights_at(const Animation& animation, double frame, params::Values& values, Shutter shutter,
                   ExposurePart part) {
  const std::vector<double> times = exposure_times(frame, shutter, part);
  for (const AnimatedLight& light : animation.lights) {
    if (!is_on(light, frame)) continue;
    static_cast<void>(values.set(light.by_direction ? "light" : "light-at", light_text(light, times)));
  }
}

int first_key(const Animation& animation) {
  int first = std::numeric_limits<int>::max();
  for (const KeyedValue* value : all_values(animation))
    if (value->keys.size() > 1) first = std::min(first, value->keys.front().frame);
  return first == std::numeric_limits<int>::max() ? 0 : first;
}

}  // namespace contrejour
