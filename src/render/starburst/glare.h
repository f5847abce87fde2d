// SPDX-License-Identifier: Apache-2.0
// Scattered light around the lights' images: a smooth fall-off with closed forms of its pixel values and its flux.
#pragma once

#include <span>

#include "contrejour/context.h"
#include "contrejour/image.h"
#include "render/starburst/light_groups.h"

namespace contrejour::inline internal {

// Adds the density (r0 / (2 pi)) (r0^2 + r^2)^-1.5 in pixels, with integral 1, times each light's flux. Accuracy: a
// pixel's mean to 1e-3. Stops when cancelled.
void add_glare(Image& image, std::span<const ImagedLight> lights, double r0_px, const Context& context);

}  // namespace contrejour::inline internal
