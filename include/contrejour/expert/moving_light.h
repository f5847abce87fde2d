// SPDX-License-Identifier: Apache-2.0
// Motion blur: a light that moves while the shutter is open has the flare of a light with the shape of its path, so it
// costs one frame instead of many (docs/physics/motion-blur.md has the accuracy).
// Thread-safety: pure functions.
#pragma once

#include <span>

#include "contrejour/export.h"
#include "contrejour/light.h"

namespace contrejour {

// The light on its way along a path. path: its directions of travel at evenly spaced times, from the opening of the
// shutter to its closing, straight lines between them; not empty. The path's middle in time becomes the light's
// direction. A disc keeps its radius, swept along the path; a light with a shape keeps that and does not move. Values
// are unchanged: the sum of the streak's image. Paths shorter than a ten thousandth of a disc's radius, or of a
// milliradian, leave a light as it is.
[[nodiscard]] CONTREJOUR_API Light swept_light(Light light, std::span<const Vec3> path);

}  // namespace contrejour
