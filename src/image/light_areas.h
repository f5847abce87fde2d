// SPDX-License-Identifier: Apache-2.0
// Connected areas of bright pixels, as sums that can be added up.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/expert/light_detection.h"

namespace contrejour::inline internal {

// Finite and positive, else 0.
[[nodiscard]] float usable_sample(float value);
[[nodiscard]] float level_of(const float* rgb);  // the largest usable sample

struct AreaSettings {
  double threshold = 1;
  double softness = 0.25;
  double max_value = DetectionSettings::kMaxLevel;
};

[[nodiscard]] bool is_bright(const float* rgb, const AreaSettings& settings);

// The weight of a bright pixel of this level in a light, 0..1.
[[nodiscard]] double matte_weight(double level, const AreaSettings& settings);

// The factor from a bright pixel's samples to its part of the light: the weight, reduced for levels beyond max_value.
[[nodiscard]] double weight_of(double level, const AreaSettings& settings);

// The areas in the order of their first pixels (rows from the top); 8 neighbours connect.
// area_of_pixel: the index of each pixel's area, -1 for none.
[[nodiscard]] std::vector<DetectedLight> bright_areas(const Image& rgb, const AreaSettings& settings,
                                                      std::vector<std::int32_t>& area_of_pixel);

// Two stops below the brightest thousandth of the pixels that are not black.
[[nodiscard]] double threshold_of_brightest(const Image& rgb);

[[nodiscard]] double total_flux(const DetectedLight& light);

// Both lights as one: fluxes add, centroid and radius are those of the union.
[[nodiscard]] DetectedLight merged(const DetectedLight& a, const DetectedLight& b);

}  // namespace contrejour::inline internal
