// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/glare.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFlat_px = 30.0;  // beyond, the value at a pixel's middle is its mean to (1 / kFlat_px)^2

// The flux over the rectangle from the centre to (x, y): the solid angle that it subtends from a height r0, over 2 pi.
double flux_to(double x, double y, double r0_px) {
  return std::atan(x * y / (r0_px * std::sqrt(r0_px * r0_px + x * x + y * y))) / (2.0 * std::numbers::pi);
}

double flux_in_pixel(double x, double y, double r0_px) {
  const double d2 = r0_px * r0_px + x * x + y * y;
  if (d2 > kFlat_px * kFlat_px) return r0_px / (2.0 * std::numbers::pi * d2 * std::sqrt(d2));
  const double left = x - 0.5, right = x + 0.5, top = y - 0.5, bottom = y + 0.5;
  return flux_to(right, bottom, r0_px) - flux_to(left, bottom, r0_px) - flux_to(right, top, r0_px) +
         flux_to(left, top, r0_px);
}

}  // namespace

void add_glare(Image& image, std::span<const ImagedLight> lights, double r0_px, const Context& context) {
  const auto width = static_cast<std::size_t>(image.width);
  parallel_for(static_cast<std::size_t>(image.height), context, [&](std::size_t row) {
    std::vector<std::array<double, 3>> sum(width);
    for (const ImagedLight& light : lights) {
      const double y = static_cast<double>(row) + 0.5 - light.centre_px.y;
      for (std::size_t x = 0; x < width; ++x) {
        const double flux = flux_in_pixel(static_cast<double>(x) + 0.5 - light.centre_px.x, y, r0_px);
        for (std::size_t c = 0; c < 3; ++c) sum[x][c] += flux * light.flux[c];
      }
    }
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 3; ++c)
        image.at(static_cast<int>(x), static_cast<int>(row), static_cast<int>(c)) += static_cast<float>(sum[x][c]);
  });
}

}  // namespace contrejour::inline internal
