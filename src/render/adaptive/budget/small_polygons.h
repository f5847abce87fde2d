// SPDX-License-Identifier: Apache-2.0
// Sizes below which details of a polygon are not resolved by pixels.
#pragma once

namespace contrejour::inline internal::adaptive {

// In smaller polygons only the flux counts, whatever irradiance their positions suggest.
inline constexpr double kSmall_px = 2.0;
// In polygons smaller than this the flux counts too: the edges that clip them are straight in the entrance plane but
// may curve on the frame.
inline constexpr double kFew_px = 8.0;
inline constexpr double kSliver = 1e-3;    // pixels: twice the mean width below which a polygon is a line
inline constexpr double kThin_px = 0.002;  // pixels: distance from a line within which a polygon is that line
inline constexpr double kPoint_px = 0.01;  // pixels: a polygon no longer than this is a point
inline constexpr double kInvisibleDetail_px = 0.3;  // pixels: details of a picture as the iris that are not visible

}  // namespace contrejour::inline internal::adaptive
