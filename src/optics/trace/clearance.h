// How clear of everything that blocks rays run along one path, but for obscurations, for searches: no sensor points, no
// transmissions, but where and by how much a ray fails, which tells the way to where rays do not. Accuracy for rays
// that come near to getting through: 1e-3 of the clear radius in float (typically 1e-5), 1e-5 in double; what is found
// ought to be traced again.
#pragma once

#include <array>
#include <cstddef>

#include "optics/trace/packet_trace.h"

namespace contrejour {

// One value a ray. Where a ray fails it has no places.
struct ClearanceArrays {
  // 0, or where the ray fails how far it is beyond: the squared cosine of incidence or refraction, or the normal's part
  // along the axis (0 at a sphere's equator), negative. Varies smoothly among rays that fail at the same test.
  float* failing = nullptr;
  float* passed = nullptr;  // how many tests a ray passes before it fails
  // Where the ray passes the surface on which it is farthest out, over the clear radius.
  float* rim_x = nullptr;
  float* rim_y = nullptr;
  std::array<float*, kMaxStopCrossings> stop_x{};  // over the stop's radius, as many as the path crosses the stop
  std::array<float*, kMaxStopCrossings> stop_y{};
};

// Entrance points are given from start().origin_mm. All arrays must have room up to the next multiple of
// kClearancePadding, whose surplus is read and written.
inline constexpr std::size_t kClearancePadding = 32;
[[nodiscard]] constexpr std::size_t clearance_padded(std::size_t count) {
  return (count + kClearancePadding - 1) / kClearancePadding * kClearancePadding;
}
void trace_clearance(const PacketPath& path, PacketPrecision precision, const float* x_mm, const float* y_mm,
                     std::size_t count, const ClearanceArrays& out);

}  // namespace contrejour
