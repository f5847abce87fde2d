// SPDX-License-Identifier: Apache-2.0
// What is added to every method's picture: the lights' own images as diffraction spreads them, and their glare.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/render.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// Checks the options of starburst and glare, and the lights that they apply to. Errors: InvalidArgument.
[[nodiscard]] Result<void> check_light_images(std::span<const Light> lights, const FrameSettings& settings);

// Adds starbursts and glare to an image, and the phases "starburst" and "glare" to its times. frame: one that was
// rendered, with the lights that have images of their own. Errors: Cancelled.
[[nodiscard]] Result<void> add_light_images(Image& image, RenderStatistics& statistics, const FrameRequest& frame,
                                            const Context& context);

// The same in images of their own, which are without pixels where nothing was drawn.
struct LightImages {
  std::vector<Image> starburst;  // one; by light, one for each layer, glare included
  std::vector<Image> glare;      // one; by light none
};

// layer_of_light: by light, the layer of each; else empty.
[[nodiscard]] Result<LightImages> draw_light_images(RenderStatistics& statistics, const FrameRequest& frame,
                                                    std::span<const std::size_t> layer_of_light,
                                                    const Context& context);

}  // namespace contrejour::inline internal
