// SPDX-License-Identifier: Apache-2.0
// What is added to every method's picture: the lights' own images as diffraction spreads them, and their glare.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/render.h"
#include "diffraction/placed_starburst.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// Checks the options of starburst and glare, and the lights that they apply to. Errors: InvalidArgument.
[[nodiscard]] Result<void> check_light_images(std::span<const Light> lights, const FrameSettings& settings);

// The starbursts of the lights that are points, for a device that may add them to the ghosts. Empty if they are more
// than kMostPlacedStarbursts, or their patterns more than a session keeps. Errors: those of lens_starburst();
// Cancelled.
[[nodiscard]] Result<std::vector<PlacedStarburst>> place_starbursts(const FrameRequest& frame, const Context& context);

// A frame to which starbursts and glare are added.
struct LightImageRequest {
  FrameRequest frame;  // that was rendered, with the lights that have images of their own
  bool has_placed = false;  // whether the image has what place_starbursts() returns
};

// Adds starbursts and glare to an image, and the phases "starburst" and "glare" to its times. Errors: Cancelled.
[[nodiscard]] Result<void> add_light_images(Image& image, RenderStatistics& statistics,
                                            const LightImageRequest& request, const Context& context);

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
