// A light's starburst through a lens before it is put on pixels: one pupil for pictures of several pitches.
#pragma once

#include <span>

#include "contrejour/lens_starburst.h"
#include "diffraction/starburst_source.h"

namespace contrejour {

// As lens_starburst, whose pixels are chosen later: StarburstSource::at.
[[nodiscard]] Result<StarburstSource> lens_pattern(const LensState& lens, const LightSource& light,
                                                   std::span<const SpectralBand> bands,
                                                   const LensStarburstSettings& settings, const Context& context);

}  // namespace contrejour
