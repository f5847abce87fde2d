// SPDX-License-Identifier: Apache-2.0
#include "cli/animation_option.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "contrejour/expert/session.h"

namespace contrejour::cli {
namespace {

constexpr int kRecordedTimes = 9;  // as many as the positions of a light's path

// A light without a name has its number as one.
std::string name_of_layer(const std::string& name) {
  const bool is_number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return is_number ? "light" + name : name;
}

params::Values without_light_values(const params::Values& values) {
  params::Values rest;
  for (const params::Parameter& p : params::all_parameters()) {
    if (p.name == "light" || p.name == "light-at") continue;
    for (const std::string& text : values.list(p.name))
      static_cast<void>(rest.set(p.name, text));  // it was checked before
  }
  return rest;
}

}  // namespace

void add_animation_option(CLI::App& command, std::string& file) {
  command
      .add_option("--lights", file,
                  "a file of lights and parameters that change from frame to frame (docs/formats/lights.md)")
      ->option_text("FILE")
      ->group("Lights");
}

Result<FrameValues> FrameValues::create(const KeyFiles& files, params::Values command_line, params::Values whole) {
  FrameValues values;
  values.command_line_ = std::move(command_line);
  values.whole_ = std::move(whole);
  if (!files.lights.empty()) {
    auto animation = read_animation(std::filesystem::path(files.lights));
    if (!animation) return tl::unexpected(animation.error());
    values.animation_ = std::move(*animation);
  } else if (!files.session.empty()) {
    if (auto ok = values.take_keys_of(files.session); !ok) return tl::unexpected(ok.error());
  }
  return values;
}

Result<void> FrameValues::take_keys_of(const std::string& session_file) {
  const auto session = read_session(std::filesystem::path(session_file));
  if (!session) return tl::unexpected(session.error());
  if (session->animation.empty()) return {};
  auto animation = read_animation(session->animation, session_file);
  if (!animation) return tl::unexpected(animation.error());
  if (!animation->lights.empty()) whole_ = command_line_.over(without_light_values(whole_));
  animation_ = std::move(*animation);
  return {};
}

params::Values FrameValues::at(int frame) const {
  if (!animation_) return whole_;
  params::Values values = without_lights(frame, frame);
  add_lights_at(*animation_, frame, values, shutter_of(frame));
  return values;
}

params::Values FrameValues::during(int frame, const ExposureTimes& times) const {
  if (!animation_) return whole_;
  const Shutter shutter = shutter_of(frame);
  params::Values values = without_lights(frame, time_of_exposure(frame, shutter, times.parameters));
  add_lights_at(*animation_, frame, values, shutter, {times.lights_from, times.lights_to});
  return values;
}

bool FrameValues::change_during(int frame) const { return !exposure_text(frame).empty(); }

bool FrameValues::do_lights_move(int frame) const {
  return animation_ && contrejour::do_lights_move(*animation_, frame, shutter_of(frame));
}

std::string FrameValues::exposure_text(int frame) const {
  const Shutter shutter = shutter_of(frame);
  if (!animation_ || !(shutter.angle_deg > 0.0)) return {};
  std::vector<params::Values> all;
  for (int k = 0; k < kRecordedTimes; ++k)
    all.push_back(without_lights(frame, time_of_exposure(frame, shutter, k / (kRecordedTimes - 1.0))));
  std::string text;
  for (const auto& [name, keys] : animation_->parameters) {
    const auto own = [&](const params::Values& values) { return values.text(name).value_or(""); };
    if (std::ranges::all_of(all, [&](const params::Values& values) { return own(values) == own(all.front()); }))
      continue;
    text += "during the exposure: " + name;
    for (const params::Values& values : all) text += " " + own(values);
    text += "\n";
  }
  return text;
}

// The shutter is that of the frame's time.
Shutter FrameValues::shutter_of(int frame) const {
  if (!animation_) return {};
  const params::Values values = without_lights(frame, frame);
  return {values.number("shutter-angle"), *values.text("shutter-offset") == "centre"};
}

params::Values FrameValues::without_lights(int frame, double time) const {
  return command_line_.over(parameters_during(*animation_, frame, time)).over(whole_);
}

params::Values FrameValues::of_still() const { return at(still_frame()); }

int FrameValues::still_frame() const { return animation_ ? first_key(*animation_) : 0; }

std::vector<std::string> FrameValues::light_names(int frame) const {
  std::vector<std::string> all;
  if (!animation_) return all;
  const params::Values values = at(frame);
  for (const bool by_direction : {true, false}) {
    const std::vector<std::string> names = names_of_lights_at(*animation_, frame, by_direction);
    const std::size_t lights = values.list(by_direction ? "light" : "light-at").size();
    all.resize(all.size() + lights - std::min(lights, names.size()));
    for (const std::string& name : names) all.push_back(name_of_layer(name));
  }
  return all;
}

std::vector<std::string> FrameValues::off_names(int frame) const {
  std::vector<std::string> off;
  if (!animation_) return off;
  std::vector<std::string> on = names_of_lights_at(*animation_, frame, true);
  for (std::string& name : names_of_lights_at(*animation_, frame, false)) on.push_back(std::move(name));
  for (const AnimatedLight& light : animation_->lights)
    if (std::ranges::find(on, light.name) == on.end()) off.push_back(name_of_layer(light.name));
  return off;
}

}  // namespace contrejour::cli
