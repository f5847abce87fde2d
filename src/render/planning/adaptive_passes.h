// SPDX-License-Identifier: Apache-2.0
// Reduces a plan's wavelengths to as few as each ghost needs, for methods that draw every wavelength by itself
// (bundle, tiled, adaptive on a device).
#pragma once

#include <optional>

#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

inline constexpr double kMaxSpread_px = 1.5;

// Limits of a band, which is halved beyond them unless it has one pass.
struct BandLimits {
  double spread_px = kMaxSpread_px;  // between the images of the ghost at the band's two ends
  double unevenness = 1e30;  // RMS of its light's difference from its passes', relative to it, with gains as GainSlopes
  double spot_px = 0.0;  // images smaller than this have their spread in proportion less, as their pixels are bright
};

// Returns the plan with `passes` for each pair. The spectrum begins as three bands with about the same visible
// light; each is halved until it is within the limits. A band is drawn at its middle pass, or at the one nearest to
// it that has at least half as much light as the brightest, with the light of all its passes. That light is
// estimated from a few of the ghost's rays, by their transmittance and the part of the pupil that is open. The flux
// of each channel is that of all passes to 2 per cent. A plan with a number of wavelengths that the user set is
// returned unchanged. nullopt when cancelled.
[[nodiscard]] std::optional<FramePlan> with_adaptive_passes(const FramePlan& plan, const LensState& lens,
                                                            const Frame& frame, const Context& context,
                                                            const BandLimits& limits = {});

}  // namespace contrejour::inline internal
