// SPDX-License-Identifier: Apache-2.0
// The speed of a device: bodonyi2023's systems with lights that move from frame to frame, warm.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/bench/paper_figures.h"
#include "contrejour/context.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/render_statistics.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct DeviceSpeed {
  std::string system;
  double f_number = 0.0;
  int lights = 0, frames = 0;
  double device_ms = 0.0;  // median, by the device's clock, without copying the picture; 0: it has none
  double frame_ms = 0.0;   // median, elapsed
  // With as many renderers at once, each on a thread of its own, from 1 on.
  std::vector<double> frames_a_second;
  double paper_ms = 0.0;   // bodonyi2023, tiled; 0: not measured there
  std::optional<double> psnr_db;  // of the first frame, against the CPU at a thirtieth of the error
  RenderStatistics last;
  std::vector<std::pair<std::string, double>> stages_ms;  // medians of the device's stages
};

struct DeviceRun {
  std::string method;
  int lights = 1, frames = 100;
  bool compares = true;
};

// Errors: those of Renderer.
[[nodiscard]] Result<DeviceSpeed> measure_device(const PaperSystem& system, const DeviceRun& run,
                                                 const params::Values& values, const Context& context);

}  // namespace contrejour::cli
