// SPDX-License-Identifier: Apache-2.0
// What is added to every method's picture: the lights' own images as diffraction spreads them, and their glare.
#pragma once

#include <span>

#include "contrejour/render.h"

namespace contrejour::inline internal {

// Checks the options of starburst and glare, and the lights that they apply to. Errors: InvalidArgument.
[[nodiscard]] Result<void> check_light_images(std::span<const Light> lights, const FrameSettings& settings);

// Adds starbursts and glare to the flare's image, and the phases "starburst" and "glare" to its times. Lights and frame
// are those of a render that succeeded. Errors: Cancelled.
[[nodiscard]] Result<void> add_light_images(Flare& flare, const LensState& lens, std::span<const Light> lights,
                                            const FrameSettings& settings, const Context& context);

}  // namespace contrejour::inline internal
