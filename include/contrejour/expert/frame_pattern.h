// SPDX-License-Identifier: Apache-2.0
// Names of a sequence's files: "plate.####.exr", "plate.@@@@.exr", "plate.%04d.exr" are the same.
// Thread-safety: pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// A frame's file is before + its number + after. The number has zeros in front up to `digits` characters, a minus sign
// included.
struct FramePattern {
  std::string before, after;
  int digits = 1;
};

// True if the file's name (its folder aside) has one of: a run of '#', a run of at least two '@', "%d", "%4d", "%04d".
[[nodiscard]] CONTREJOUR_API bool is_frame_pattern(std::string_view name);

// Errors: InvalidArgument if there is none, or more than one.
[[nodiscard]] CONTREJOUR_API Result<FramePattern> parse_frame_pattern(std::string_view name);

[[nodiscard]] CONTREJOUR_API std::filesystem::path file_of_frame(const FramePattern& pattern, int frame);

// The frames whose files exist, in rising order. Errors: Io if the folder cannot be read.
[[nodiscard]] CONTREJOUR_API Result<std::vector<int>> frames_on_disk(const FramePattern& pattern);

}  // namespace contrejour
