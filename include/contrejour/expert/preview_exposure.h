// SPDX-License-Identifier: Apache-2.0
// The exposure of a preview. Pixels are scene-linear. Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"

namespace contrejour::params {

// The exposure, in stops, that brings the 99.9th percentile of the samples to 0.7, from -100 to 100; 0 for a picture
// without light.
[[nodiscard]] CONTREJOUR_API double automatic_exposure(const Image& rgb);

// The exposure of a preview if the values contain none: automatic_exposure(), or 0 stops.
enum class DefaultExposure { Automatic, None };

// The exposure that the values contain, or the default.
[[nodiscard]] CONTREJOUR_API PreviewSettings preview_settings(const Values& values, const Image& rgb,
                                                              DefaultExposure otherwise);

}  // namespace contrejour::params
