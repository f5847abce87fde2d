// SPDX-License-Identifier: Apache-2.0
// The cost of frames of many lenses: the first frame of a fresh process, and warm frames in this process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// A lens as `bench lenses` configures it: its file or name, and the focal length if it is a zoom lens.
struct BenchedLens {
  std::string file;
  std::optional<double> focal_length_mm = std::nullopt;
};

// The apertures and sizes of the measured frames; all have one light at u,v = 0.7,0.35.
struct FrameCase {
  bool wide_open = false;  // maximum aperture; else f/8, or the maximum aperture of a slower lens
  std::string size;        // "1920x1080"
};
[[nodiscard]] const std::vector<FrameCase>& frame_cases();
[[nodiscard]] std::string name_of(const FrameCase& frame_case);  // "f/8 320x180"

struct FrameCost {
  double f_number = 0;
  int ghosts = 0;
  double first_ms = 0;  // 0 if not measured
  double warm_ms = 0;
  [[nodiscard]] double ghost_ms() const { return (first_ms > 0 ? first_ms : warm_ms) / ghosts; }
};

// The user's values with the case's and the light's added.
[[nodiscard]] Result<params::Values> values_of(const BenchedLens& lens, const FrameCase& frame_case,
                                               const params::Values& values);

struct FrameRunning {
  int runs = 3;  // the number of frames, and of fresh processes; the fastest counts
  bool warm_only = false;
  bool processor_time = false;  // of all threads, which excludes other programs; else elapsed time
};

// Renders one frame and returns its time in ms, from the configured lens to the picture in memory: the work of a fresh
// process.
[[nodiscard]] Result<double> frame_ms(const std::string& lens, const params::Values& values,
                                      const FrameRunning& running);

// Errors: those of the lens and of rendering; Cancelled.
[[nodiscard]] Result<FrameCost> frame_cost(const BenchedLens& lens, const FrameCase& frame_case,
                                           const params::Values& values, const FrameRunning& running);

}  // namespace contrejour::cli
