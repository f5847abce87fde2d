// SPDX-License-Identifier: Apache-2.0
// Traces the clearance of rays along one path, for searches: their distance from rims and iris, obscurations excluded.
// It gives no sensor points and no transmittances, but where and by how much a ray fails, which leads a search to rays
// that get through. Accuracy for rays close to getting through: 1e-3 of the clear radius in float (typically 1e-5),
// 1e-5 in double; trace the results of a search again.
#pragma once

#include <array>
#include <cstddef>

#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal {

// One value a ray. Positions of a ray that fails are undefined.
struct ClearanceArrays {
  // 0, or for a ray that fails the negative amount by which it does: the squared cosine of incidence or refraction, or
  // the normal's component along the axis (0 at a sphere's equator). It varies smoothly among rays that fail at the
  // same test.
  float* failing = nullptr;
  float* passed = nullptr;  // the number of tests that a ray passes before it fails
  // The ray's point on the surface where its relative height is largest, over the clear radius.
  float* rim_x = nullptr;
  float* rim_y = nullptr;
  std::array<float*, kMaxStopCrossings> stop_x{};  // over the stop's radius, one array a stop crossing
  std::array<float*, kMaxStopCrossings> stop_y{};
};

// Entrance points are relative to start().origin_mm. All arrays must extend to the next multiple of kClearancePadding;
// the padding is read and written.
inline constexpr std::size_t kClearancePadding = 32;
[[nodiscard]] constexpr std::size_t clearance_padded(std::size_t count) {
  return (count + kClearancePadding - 1) / kClearancePadding * kClearancePadding;
}
void trace_clearance(const PacketPath& path, PacketPrecision precision, const float* x_mm, const float* y_mm,
                     std::size_t count, const ClearanceArrays& out);

}  // namespace contrejour::inline internal
