// How bright a picture to look at is shown.
#pragma once

#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/parameter_values.h"

namespace contrejour::cli {

enum class UsualExposure { Automatic, AsItIs };

// What --exposure says, or what is usual: automatic brings the 99.9th percentile of the samples to 0.7.
[[nodiscard]] PreviewSettings preview_settings(const params::Values& values, const Image& rgb, UsualExposure usual);

}  // namespace contrejour::cli
