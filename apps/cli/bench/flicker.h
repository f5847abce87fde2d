// SPDX-License-Identifier: Apache-2.0
// Measures flicker: how much what `adaptive` decides changes from frame to frame while a light moves by a tenth of a
// pixel a frame. The second difference in time, f(t + 1) - 2 f(t) + f(t - 1), removes steady motion; what it has beyond
// that of frames with a hundredth of the error is the method's own.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/bench/paper_figures.h"
#include "contrejour/context.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/result.h"

namespace contrejour::cli {

// Effects that are added to a point light behind a clean lens without diffraction.
struct FlickerCase {
  const char* name;
  bool ringing = false, size = false, dirt = false;
};
[[nodiscard]] std::span<const FlickerCase> flicker_cases();

inline constexpr double kFineError = 1e-4;
inline constexpr double kStep_px = 0.1;

struct Flicker {
  std::string system, effects;
  int frames = 0;
  // The middle one of the three at which `difference` is the largest, counted from the shot's start.
  int worst_frame = 0;
  // Second differences of samples that are clipped at the peak, as errors are measured (compare() of metrics.h): as the
  // RMS over the pixels of a frame, over that peak, the largest of all times.
  double rendered = 0.0;  // of the frames
  double fine = 0.0;  // of those at kFineError
  double difference = 0.0;  // of the frames minus those at kFineError
  double mean_difference = 0.0;  // the same, as the RMS over time
  double unclipped = 0.0;  // as `difference`, without clipping: spots brighter than the peak count in full
  double pixel_difference = 0.0;  // the largest of a single sample, without clipping
  // Second differences of the sum of a channel over that sum: the largest of all times and channels.
  double flux = 0.0, fine_flux = 0.0;
};

// The frames of the shot that are measured.
struct FlickerFrames {
  int first = 0, count = 200;
};

// The values give the error, the frame's size and all other settings. Errors: Cancelled.
[[nodiscard]] Result<Flicker> measure_flicker(const PaperSystem& system, const FlickerCase& effects,
                                              const FlickerFrames& frames, const params::Values& values,
                                              const Context& context);

}  // namespace contrejour::cli
