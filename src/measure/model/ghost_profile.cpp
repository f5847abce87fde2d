// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/ghost_profile.h"

#include <algorithm>
#include <cmath>

namespace contrejour {
namespace {

constexpr double kSpacings = kProfileRings - 1;
constexpr double kCentre = 1e-9;  // of rho, below which there is no direction

}  // namespace

ProfileWeights profile_weights(const GhostOutline& outline, Vec2 point) {
  const double x = (point.x - outline.centre) / (point.x < outline.centre ? outline.left : outline.right);
  const double y = point.y / outline.half_height;
  const double rho = std::hypot(x, y);
  const double u = std::min(rho, 1.0) * kSpacings;
  const double ring = std::min(std::floor(u), kSpacings - 1.0), part = u - ring;
  // cos(phi) and cos(2 phi) with their derivatives with respect to x and y.
  const double c = rho > kCentre ? x / rho : 0.0, s = rho > kCentre ? y / rho : 0.0;
  const Vec2 by_rho = rho > kCentre ? Vec2{c, s} : Vec2{};
  const double turn = rho > kCentre ? s / rho : 0.0;  // d phi = (-s, c) / rho, d cos(phi) = -s d phi
  const std::array<double, kProfileHarmonics> cosine{1.0, c, 2.0 * c * c - 1.0};
  const std::array<Vec2, kProfileHarmonics> by_phi{Vec2{}, Vec2{s, -c} * turn, Vec2{s, -c} * (4.0 * c * turn)};
  const double slope = rho < 1.0 ? kSpacings : 0.0;
  ProfileWeights weights;
  for (std::size_t side = 0; side < 2; ++side) {
    const double hat = side == 0 ? 1.0 - part : part, by_u = side == 0 ? -slope : slope;
    for (std::size_t m = 0; m < kProfileHarmonics; ++m) {
      const std::size_t at = side * kProfileHarmonics + m, k = static_cast<std::size_t>(ring) + side;
      if (m > 0 && k == 0) continue;
      weights.term[at] = profile_index({m, k});
      weights.value[at] = hat * cosine[m];
      weights.by_place[at] = by_rho * (by_u * cosine[m]) + by_phi[m] * hat;
    }
  }
  return weights;
}

}  // namespace contrejour
