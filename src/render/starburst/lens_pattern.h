// SPDX-License-Identifier: Apache-2.0
// A light's starburst through a lens before it is sampled at pixels: one pupil serves pictures of several pitches.
#pragma once

#include <span>

#include "contrejour/expert/lens_starburst.h"
#include "diffraction/starburst_source.h"

namespace contrejour::inline internal {

// As lens_starburst, but pixels are chosen later: StarburstSource::at.
[[nodiscard]] Result<StarburstSource> lens_pattern(const LensState& lens, const LightSource& light,
                                                   std::span<const SpectralBand> bands,
                                                   const LensStarburstSettings& settings, const Context& context);

}  // namespace contrejour::inline internal
