// SPDX-License-Identifier: Apache-2.0
// This budget decides how finely light behind a stop pattern is resolved.
#pragma once

#include "render/adaptive/cells/band_context.h"
#include "render/adaptive/cells/stop_map.h"
#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

// Light dimmer than this many times the negligible level, thus 0.1 of the error that all pixels may have, is drawn with
// its mean transmittance over a cell.
inline constexpr double kMeanBelow = 10.0;
inline constexpr double kWorthCutting_px = 400.0;  // smaller cells are not cut; all of their pixels are looked up

// The difference of transmittances within a cell, whose brightest irradiance is `level`, that is ignored.
[[nodiscard]] double ignored_difference(const BandContext& band, double level);

// The number of look-ups across a pixel. One look-up averages over a square in the stop as large as the pixel's image
// there, which is not a square. The error is a fraction of the fringes that are as fine as pixels, and falls as the
// square of the number of look-ups across a pixel. Fringes along edges are fainter the finer they are. transmitted:
// largest transmittance of the pattern.
[[nodiscard]] int samples_across_pixel(const BandContext& band, const LinearIrradiance& irradiance, double transmitted,
                                       const StopMap& map);

}  // namespace contrejour::inline internal::adaptive
