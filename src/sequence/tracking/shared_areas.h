// SPDX-License-Identifier: Apache-2.0
// Areas that are not one light each: parts of a light that something divides, and lights whose areas meet.
// Thread-safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "sequence/tracking/light_motion.h"

namespace contrejour::inline internal {

// Detections that have no light but lie within the area that a light had: further parts of it. Each becomes a part of
// the light whose centre is nearest. Returns the light of each detection, -1 for none, those of detection_of_light too.
[[nodiscard]] std::vector<int> lights_of_parts(std::span<const LightMotion> motions,
                                               std::span<const DetectedLight> detections,
                                               std::span<const int> detection_of_light);

// Lights that have no detection but are predicted within one that is bright enough for them too: the areas met.
// Returns the detection of each such light, -1 for none.
[[nodiscard]] std::vector<int> detections_shared(std::span<const LightMotion> motions,
                                                 std::span<const DetectedLight> detections,
                                                 std::span<const int> detection_of_light);

// One light of several areas, or several lights of one area.
[[nodiscard]] DetectedLight as_one(const DetectedLight& a, const DetectedLight& b);

// True if the point lies in the light's bounding box, or within `margin_px` of it.
[[nodiscard]] bool is_within(const DetectedLight& light, Vec2 point_px, double margin_px);

}  // namespace contrejour::inline internal
