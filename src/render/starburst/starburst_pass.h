// What the driver adds to every method's picture: the lights' starbursts.
#pragma once

#include <span>

#include "contrejour/render.h"

namespace contrejour {

// Are the options of the starburst usable? Errors: InvalidArgument.
[[nodiscard]] Result<void> check_starburst(const RenderSettings& settings);

// Adds the starbursts to the flare's image, and the phase "starburst" to its times. Lights and frame are those of a
// render that succeeded. Errors: Cancelled.
[[nodiscard]] Result<void> add_starbursts(Flare& flare, const LensState& lens, std::span<const Light> lights,
                                          const RenderSettings& settings, const Context& context);

}  // namespace contrejour
