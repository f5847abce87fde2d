// What frames of many lenses cost: a first one, by a fresh process, and warm ones in this process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contrejour/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// A lens as `bench lenses` sets it: its file or name, and the focal length of a zoom that has several.
struct BenchedLens {
  std::string file;
  std::optional<double> focal_length_mm = std::nullopt;
};

// All frames have one light at u,v = 0.7,0.35 and vary by these.
struct FrameCase {
  bool wide_open = false;  // else f/8, or the widest of a slower lens
  std::string size;        // "1920x1080"
};
[[nodiscard]] const std::vector<FrameCase>& frame_cases();
[[nodiscard]] std::string name_of(const FrameCase& frame_case);  // "f/8 320x180"

struct FrameCost {
  double f_number = 0;
  int ghosts = 0;
  double first_ms = 0;  // 0 where it was not measured
  double warm_ms = 0;
  [[nodiscard]] double ghost_ms() const { return (first_ms > 0 ? first_ms : warm_ms) / ghosts; }
};

// The user's values with those of the case and the light.
[[nodiscard]] Result<params::Values> values_of(const BenchedLens& lens, const FrameCase& frame_case,
                                               const params::Values& values);

struct FrameRunning {
  int runs = 3;  // of so many frames, and so many fresh processes, the fastest counts
  bool warm_only = false;
  bool processor_time = false;  // of all threads together, which other programs do not take from; else the clock's
};

// Renders one frame and says how many ms it took, from the lens set up to the picture in memory: what a fresh process
// is started for.
[[nodiscard]] Result<double> frame_ms(const std::string& lens, const params::Values& values,
                                      const FrameRunning& running);

// Errors: those of the lens and of rendering; Cancelled.
[[nodiscard]] Result<FrameCost> frame_cost(const BenchedLens& lens, const FrameCase& frame_case,
                                           const params::Values& values, const FrameRunning& running);

}  // namespace contrejour::cli
