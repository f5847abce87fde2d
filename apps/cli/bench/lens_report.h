// SPDX-License-Identifier: Apache-2.0
// The results of `bench lenses` as text and as JSON: each lens, and over all of them the median, the 90th percentile
// and the worst.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/lens_frames.h"
#include "cli/console.h"

namespace contrejour::cli {

struct BenchedFrames {
  std::string name;               // the file's, without its folders
  std::vector<FrameCost> frames;  // in the order of frame_cases()
};

struct LensBench {
  BenchedFrames baseline;  // the lens that costs are relative to, measured in the same run
  std::vector<BenchedFrames> lenses;
  std::vector<std::string> refused;  // files that could not be measured, and why
};

[[nodiscard]] std::string lens_bench_text(const LensBench& bench);
[[nodiscard]] Json lens_bench_json(const LensBench& bench, const FrameRunning& running);

}  // namespace contrejour::cli
