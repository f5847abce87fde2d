// SPDX-License-Identifier: Apache-2.0
// The largest brightness of boxes of the pupil behind a stop pattern.
#pragma once

#include <optional>

#include "ghosts/light_frame.h"
#include "render/adaptive/cells/ray_map_names.h"
#include "render/stop_patterns/band_stop_pattern.h"

namespace contrejour::inline internal::adaptive {

// An estimate of the largest irradiance on the sensor, per mm^2 and for a gain of 1, between rays of a ray set that
// arrive. Next to rays that fail it is taken to be as large as anywhere. If it exceeds `enough`, the search ends with a
// value above `enough`. with_mirror_image: includes mirrored(ray_set). unit: of the ray set's stop coordinates, in stop
// radii. Empty if no four neighbouring rays all arrive.
[[nodiscard]] std::optional<double> brightest_transmitted(const LobattoRays& ray_set, bool with_mirror_image,
                                                          const stop_patterns::BandStopPattern& screen, double unit,
                                                          const LightFrame& light, double enough);

}  // namespace contrejour::inline internal::adaptive
