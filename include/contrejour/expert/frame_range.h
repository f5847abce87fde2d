// SPDX-License-Identifier: Apache-2.0
// Numbers of frames as text, as Nuke writes them: "1001-1240", "1001-1100x2,1200".
// Thread-safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

inline constexpr std::size_t kMaxFrames = 1'000'000;  // of one range

// Frames in rising order, each once. A part is a number, FIRST-LAST or FIRST-LASTxSTEP; numbers may be negative, and
// commas or spaces separate parts. Errors: InvalidArgument for anything else, for LAST below FIRST, and for more than
// kMaxFrames frames.
[[nodiscard]] CONTREJOUR_API Result<std::vector<int>> parse_frame_range(std::string_view text);

// The shortest such text of rising frames: "1001-1005x2,1009".
[[nodiscard]] CONTREJOUR_API std::string frame_range_text(const std::vector<int>& frames);

}  // namespace contrejour
