// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/ghost_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour::inline internal::area {

double ellipse_px(const LinearMap& covariance) {
  return 4.0 * std::numbers::pi * std::sqrt(std::max(covariance.determinant(), 0.0));
}

double light_area_px(std::span<const GhostPart> parts, const LinearMap& blur) {
  constexpr double kPixel = 1.0 / 12.0;  // variance across a pixel
  const LinearMap blur_of_two = (blur + LinearMap{} * kPixel) * 2.0;
  double squares = 0.0, light = 0.0;  // squares: the integral of the squared irradiance, times 2 pi
  for (const GhostPart& a : parts) {
    light += a.light;
    for (const GhostPart& b : parts) {
      const LinearMap both = a.covariance + b.covariance + blur_of_two;
      const Vec2 d = a.at_px - b.at_px;
      const double product =
          a.light * b.light * std::exp(-0.5 * dot(d, inverse(both)(d))) / std::sqrt(both.determinant());
      if (std::isfinite(product)) squares += product;
    }
  }
  return squares > 0.0 ? 2.0 * std::numbers::pi * light * light / squares : ellipse_px(blur) + 1.0;
}

}  // namespace contrejour::inline internal::area
