// SPDX-License-Identifier: Apache-2.0
#include "diffraction/sharp_zone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diffraction/pixel_profile.h"

namespace contrejour::inline internal {
namespace {

constexpr float kPiF = std::numbers::pi_v<float>;

// The middle of a pixel's chord along a direction at a distance from the pixel's middle, measured along the chord from
// the foot of the perpendicular.
float chord_middle(float along_x, float along_y, float distance) {
  const auto range = [&](float along, float offset) {
    const float a = (0.5F - offset) / along, b = (-0.5F - offset) / along;
    return a < b ? std::pair{a, b} : std::pair{b, a};
  };
  constexpr float kAcross = 1e-3F;  // of a direction's cosines: it counts as parallel to that pair of sides
  if (std::abs(along_x) < kAcross || std::abs(along_y) < kAcross) return 0.0F;
  const auto [x0, x1] = range(along_x, -along_y * distance);
  const auto [y0, y1] = range(along_y, along_x * distance);
  return 0.5F * (std::max(x0, y0) + std::min(x1, y1));
}

}  // namespace

void read_zone(const SharpZone& zone, std::size_t bins, float row, float turns, Vec2 p, float* rgb) {
  const auto whole = static_cast<float>(bins);
  float position = turns * whole - static_cast<float>(zone.first_bin);
  if (position < 0.0F) position += whole;
  const auto r = static_cast<float>(length(p));
  const float along_x = static_cast<float>(p.x) / r, along_y = static_cast<float>(p.y) / r;
  const float px_per_bin = r * kPiF / whole;
  const float rows_per_px = kRowsPerOctave / (std::numbers::ln2_v<float> * r);
  const PixelProfile<float> profile(along_x, along_y, 1.0F);
  const std::size_t cells = zone.cells();
  const float extent = profile.extent() / px_per_bin;
  auto cell = static_cast<std::size_t>(
      std::max<std::ptrdiff_t>(
          std::upper_bound(zone.edge.begin(), zone.edge.end(), position - extent) - zone.edge.begin(), 1) -
      1);
  float fraction_before = 0.0F, sum[4] = {};
  float from = -profile.extent();
  for (; cell < cells && fraction_before < 1.0F; ++cell) {
    const float to = (zone.edge[cell + 1] - position) * px_per_bin;
    const float fraction = to < profile.extent() ? profile.fraction_below(to) : 1.0F;
    const float weight = fraction - fraction_before;
    const float middle = chord_middle(along_x, along_y, 0.5F * (from + std::min(to, profile.extent())));
    const float at = std::clamp(row + rows_per_px * middle, 0.0F, static_cast<float>(kRowsPerOctave));
    const std::size_t above = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kRowsPerOctave - 1));
    const float t = at - static_cast<float>(above);
    const float* const first = zone.rgb0.data() + (above * cells + cell) * 4;
    const float* const second = first + cells * 4;
    for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * (first[c] + t * (second[c] - first[c]));
    fraction_before = fraction;
    from = to;
  }
  std::copy_n(sum, 3, rgb);
}

}  // namespace contrejour::inline internal
