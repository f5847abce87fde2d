// SPDX-License-Identifier: Apache-2.0
// The moving shot through a lens, as `contrejour lights track` and `contrejour apply` do it: its lights are followed
// from frame to frame, and their flare is added to each.
#pragma once

#include <filesystem>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"
#include "demo/street_shot.h"

namespace contrejour::demo {

struct MovingShot {
  std::size_t lights = 0;                // that were tracked
  std::filesystem::path lights_file, contact_sheet;
};

// `folder` has the footage. Writes lights.toml, flared.####.exr, and contact-sheet.png with all frames in order.
[[nodiscard]] Result<MovingShot> flare_footage(const ShotSettings& settings, const LensState& lens,
                                               const params::Values& values, const std::filesystem::path& folder);

}  // namespace contrejour::demo
