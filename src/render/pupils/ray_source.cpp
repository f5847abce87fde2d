// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::pupils {

void TracedRays::rays(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm,
                      std::size_t count, const TracedArrays& out) {
  path_.start_from(origin_mm);
  trace_packets(path_, precision, x_mm, y_mm, count, out);
}

void TracedRays::transmissions(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm,
                               std::size_t count, float* out) {
  unused_.resize((3 + 2 * kMaxStopCrossings) * count);
  const auto unused = [&](std::size_t f) { return unused_.data() + f * count; };
  TracedArrays arrays{unused(0), unused(1), out, unused(2), {}, {}, nullptr, 0};
  for (std::size_t c = 0; c < static_cast<std::size_t>(path_.stop_crossings()); ++c) {
    arrays.stop_x[c] = unused(3 + 2 * c);
    arrays.stop_y[c] = unused(4 + 2 * c);
  }
  rays(origin_mm, precision, x_mm, y_mm, count, arrays);
}

void TracedRays::clearances(Vec2 origin_mm, PacketPrecision precision, const float* x_mm, const float* y_mm,
                            std::size_t count, const ClearanceArrays& out) {
  path_.start_from(origin_mm);
  trace_clearance(path_, precision, x_mm, y_mm, count, out);
}

}  // namespace contrejour::inline internal::pupils
