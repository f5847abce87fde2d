// SPDX-License-Identifier: Apache-2.0
// The moving shot as files.
#pragma once

#include <filesystem>

#include "contrejour/result.h"
#include "demo/street_shot.h"

namespace contrejour::demo {

inline constexpr int kFirstFrame = 1001;

// Writes plate.####.exr (halves) from frame 1001 on, and true-lights.toml, into a folder that exists.
[[nodiscard]] Result<void> write_footage(const ShotSettings& settings, const std::filesystem::path& folder);

}  // namespace contrejour::demo
