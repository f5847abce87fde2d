// The exposure of a preview. Pixels are scene-linear. Thread-safety: pure functions.
#pragma once

#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/parameter_values.h"

namespace contrejour::params {

// The exposure, in stops, that brings the 99.9th percentile of the samples to 0.7, from -100 to 100; 0 for a picture
// without light.
[[nodiscard]] double automatic_exposure(const Image& rgb);

// What a preview has where the values have no `exposure`.
enum class UsualExposure { Automatic, AsItIs };

// The exposure that the values give, or the usual one.
[[nodiscard]] PreviewSettings preview_settings(const Values& values, const Image& rgb, UsualExposure usual);

}  // namespace contrejour::params
