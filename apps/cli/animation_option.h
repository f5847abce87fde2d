// SPDX-License-Identifier: Apache-2.0
// --lights FILE: lights and parameters that change from frame to frame.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "contrejour/expert/animation.h"
#include "contrejour/expert/exposure.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

void add_animation_option(CLI::App& command, std::string& file);

// The files that keys come from: one of --lights, and the session whose frames are requested. Either may be empty.
struct KeyFiles {
  std::string lights, session;
};

// The values of every frame. The command line overrides the file, and the file overrides the preset; lights of the
// command line and of the file are added up.
class FrameValues {
 public:
  // command_line: as given; whole: with the preset's values too. A session's keys hold unless there is a file of
  // --lights; its animated lights stand in place of its own.
  [[nodiscard]] static Result<FrameValues> create(const KeyFiles& files, params::Values command_line,
                                                  params::Values whole);

  [[nodiscard]] params::Values at(int frame) const;
  // The values at a time while the frame's shutter is open, with its lights at their times.
  [[nodiscard]] params::Values during(int frame, const ExposureTimes& times) const;
  // Whether values other than those of lights change while the frame's shutter is open.
  [[nodiscard]] bool change_during(int frame) const;
  [[nodiscard]] bool do_lights_move(int frame) const;  // while its shutter is open
  // The values that change, at several times of the exposure, for a frame's record; empty where none changes.
  [[nodiscard]] std::string exposure_text(int frame) const;
  // For a picture without a number: the values of the first frame that has a key.
  [[nodiscard]] params::Values of_still() const;
  // Whether the file has lights, on or off; then there is none by default.
  [[nodiscard]] bool have_lights() const { return animation_ && !animation_->lights.empty(); }
  // The names of the lights of at(frame), in the order in which they become lights; empty for those of the command
  // line.
  [[nodiscard]] std::vector<std::string> light_names(int frame) const;
  // The names of the file's lights that are off in a frame.
  [[nodiscard]] std::vector<std::string> off_names(int frame) const;
  [[nodiscard]] int still_frame() const;  // that of_still() is of
  [[nodiscard]] bool may_change_lens() const { return animation_ && !animation_->parameters.empty(); }

 private:
  FrameValues() = default;
  [[nodiscard]] Result<void> take_keys_of(const std::string& session_file);

  [[nodiscard]] Shutter shutter_of(int frame) const;
  [[nodiscard]] params::Values without_lights(int frame, double time) const;

  std::optional<Animation> animation_;
  params::Values command_line_, whole_;
};

}  // namespace contrejour::cli
