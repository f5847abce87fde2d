// SPDX-License-Identifier: Apache-2.0
// The light scattered about a light's own image, in what a fit leaves of its photographs: it is no part of a fit, and
// would hide in the residual what the fit lacks. It moves with the light and has the same form at every station
// (docs/physics/measured-flare.md, "The halo"): its level at a distance is the median over all directions, then over
// the stations; ghosts are elsewhere at most of them. Streaks of the starburst stay. Thread-safety: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "contrejour/image.h"

namespace contrejour::studio {

// By distance from the light in steps of a pixel, for each channel; a ring of which too little is inside the picture
// has no level (NaN).
using RingLevels = std::array<std::vector<float>, 3>;

// residual: a photograph less its fit. The halo is sought and left out where the photograph is not 0 in all channels,
// as it is outside its frame.
[[nodiscard]] RingLevels ring_levels(const Image& residual, const Image& photograph, Vec2 light_px);

// It takes at least three stations; with fewer there is none (empty).
[[nodiscard]] RingLevels halo_of(std::span<const RingLevels> stations);

// The residual less the halo, as bright as this station has it, within a third.
[[nodiscard]] Image without_halo(const Image& residual, const Image& photograph, const RingLevels& station,
                                 const RingLevels& halo, Vec2 light_px);

}  // namespace contrejour::studio
