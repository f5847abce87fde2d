// SPDX-License-Identifier: Apache-2.0
#include "cli/animation_option.h"

#include <algorithm>
#include <utility>

namespace contrejour::cli {
namespace {

// A light without a name has its number as one.
std::string name_of_layer(const std::string& name) {
  const bool is_number = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  return is_number ? "light" + name : name;
}

}  // namespace

void add_animation_option(CLI::App& command, std::string& file) {
  command
      .add_option("--lights", file,
                  "a file of lights and parameters that change from frame to frame (docs/formats/lights.md)")
      ->option_text("FILE")
      ->group("Lights");
}

Result<FrameValues> FrameValues::create(const std::string& file, params::Values command_line, params::Values whole) {
  FrameValues values;
  values.command_line_ = std::move(command_line);
  values.whole_ = std::move(whole);
  if (file.empty()) return values;
  auto animation = read_animation(std::filesystem::path(file));
  if (!animation) return tl::unexpected(animation.error());
  values.animation_ = std::move(*animation);
  return values;
}

params::Values FrameValues::at(int frame) const {
  if (!animation_) return whole_;
  params::Values values = command_line_.over(parameters_at(*animation_, frame)).over(whole_);
  const Shutter shutter{values.number("shutter-angle"), *values.text("shutter-offset") == "centre"};
  add_lights_at(*animation_, frame, values, shutter);
  return values;
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
