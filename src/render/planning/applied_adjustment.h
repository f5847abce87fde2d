// SPDX-License-Identifier: Apache-2.0
// An artist's adjustments of ghosts (GhostOptions), resolved for each ghost as renderers apply them.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/ghost.h"
#include "contrejour/expert/ghost_options.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour::inline internal {

// A factor on the gain of every pass, and a displacement of the ghost. {1, 1, 1} and {} leave the ghost as computed.
struct AppliedAdjustment {
  Rgb tint{1, 1, 1};
  Vec2 shift_mm;

  [[nodiscard]] Rgb tinted(const Rgb& gain) const { return {gain[0] * tint[0], gain[1] * tint[1], gain[2] * tint[2]}; }
  [[nodiscard]] Frame placed(Frame frame) const {
    frame.shift_mm = frame.shift_mm + shift_mm;
    return frame;
  }
};

// Errors: InvalidArgument for numbers that are not finite, negative gains and colours, offsets and scatter beyond
// kFarthestOffset times the frame's height, a ramp whose positions do not increase or lie beyond kFarthestPosition, and
// ghosts that the lens does not have.
inline constexpr double kFarthestOffset = 1000.0, kFarthestPosition = 1e6;
[[nodiscard]] Result<void> check_ghost_options(const LensState& lens, const GhostOptions& options);

// Errors: InvalidArgument for a light whose value times a ghost's gains exceeds kMaxLightValue.
[[nodiscard]] Result<void> check_brightness(std::span<const Light> lights, std::span<const Ghost> ghosts,
                                            std::span<const AppliedAdjustment> adjustments,
                                            const GhostOptions& options);

// Returns one for each ghost.
[[nodiscard]] std::vector<AppliedAdjustment> applied_adjustments(const LensState& lens, std::span<const Ghost> ghosts,
                                                                 const GhostOptions& options, const Frame& frame);

}  // namespace contrejour::inline internal
