// SPDX-License-Identifier: Apache-2.0
// Draws the rings of a starburst on pixels: near the centre cell by cell, farther out from the rings' means over
// pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/tasks.h"
#include "contrejour/expert/starburst.h"
#include "diffraction/near_field.h"
#include "diffraction/ring_reader.h"
#include "diffraction/sheet_rows.h"
#include "diffraction/starburst_core.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal {

void add_near_row(const NearField& near, Vec2 centre_px, double y, std::size_t width, float* rgb) {
  if (std::abs(y) > kNear_px) return;
  const double half = std::sqrt(kNear_px * kNear_px - y * y);
  const auto clamped = [&](double x) {
    return static_cast<std::size_t>(std::clamp(x, 0.0, static_cast<double>(width)));
  };
  // With the same condition as in read_rings.
  for (std::size_t x = clamped(std::floor(centre_px.x - half - 0.5)); x < clamped(centre_px.x + half + 0.5); ++x) {
    const double from_x = 0.5 - centre_px.x + static_cast<double>(x);
    if (from_x * from_x >= kNear_px * kNear_px - y * y) continue;
    const std::array<double, 3> flux = near.flux({{from_x - 0.5, -y - 0.5}, {from_x + 0.5, -y + 0.5}});
    for (std::size_t c = 0; c < 3; ++c) rgb[3 * x + c] += static_cast<float>(flux[c]);
  }
}

}  // namespace contrejour::inline internal

namespace contrejour {

void add_starburst(Image& image, const Starburst& starburst, Vec2 centre_px, const Rgb& flux, const Context& context) {
  if (image.channels != 3 || image.pixels.size() != image.index(0, image.height)) return;
  if (starburst.rings() == nullptr || !is_drawable(centre_px)) return;
  const StarburstRings& rings = *starburst.rings();
  const auto width = static_cast<std::size_t>(image.width);
  const std::array<float, 3> scale{static_cast<float>(flux[0]), static_cast<float>(flux[1]),
                                   static_cast<float>(flux[2])};
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    const double y = static_cast<double>(row) + 0.5 - centre_px.y;
    if (std::abs(y) > rings.radius_px) return;
    std::vector<float> rgb(3 * (width + 1));
    read_rings(rings, 0.5 - centre_px.x, y, width, rgb.data());
    add_near_row(*rings.near, centre_px, y, width, rgb.data());
    add_between(rgb.data(), 0.0F, scale, 3 * width, image.row(static_cast<int>(row)).data());
  });
}

}  // namespace contrejour
