// SPDX-License-Identifier: Apache-2.0
// From a rendered frame to the flare of a photograph's pixels.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/apply.h"
#include "contrejour/expert/picture_layers.h"

namespace contrejour::inline internal {

// The settings of the frame that is rendered for a plan.
[[nodiscard]] FrameSettings settings_of(const FlarePlan& plan, const params::Values& values);

[[nodiscard]] PictureFlare flare_without_lights(const FlarePlan& plan);

// Errors: those of picture_of_flare().
[[nodiscard]] Result<PictureFlare> on_picture(Flare frame, const FlarePlan& plan, const Image& rgb);

[[nodiscard]] Result<PictureLayers> layers_on_picture(LayeredFlare frame, const FlarePlan& plan, const Image& rgb);

}  // namespace contrejour::inline internal
