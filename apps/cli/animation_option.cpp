// SPDX-License-Identifier: Apache-2.0
#include "cli/animation_option.h"

#include <utility>

namespace contrejour::cli {

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

params::Values FrameValues::of_still() const { return animation_ ? at(first_key(*animation_)) : whole_; }

}  // namespace contrejour::cli
