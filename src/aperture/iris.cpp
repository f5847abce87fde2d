// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/iris.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "aperture/iris_blades.h"
#include "base/split_mix.h"
#include "contrejour/expert/iris_field.h"

namespace contrejour::inline internal {
namespace {

constexpr double kStraight = 1e-5;  // curvatures below it bend an edge by less than 5e-6 stop radii

// Distance to a regular iris's nearest bound: the point is folded into the sector of one edge. Inside and next to the
// edge this is the distance to the opening; beyond a corner the true distance is up to 1 / cos(pi / n) times as large.
double folded_distance(const Iris& iris, Vec2 point) {
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  const double angle = std::atan2(point.y, point.x) - iris.rotation_rad;
  const double folded = angle - sector * std::floor(angle / sector) - 0.5 * sector;
  const double r = length(point);
  if (iris.curvature < kStraight) return r * std::cos(folded) - iris.blade_radius * std::cos(0.5 * sector);
  return edge_bound(iris, 0.0, 0.0).distance({r * std::cos(folded), r * std::sin(folded)});
}

}  // namespace

Vec2 rotated(Vec2 p, double angle_rad) {
  const double cosine = std::cos(angle_rad);
  const double sine = std::sin(angle_rad);
  return {cosine * p.x - sine * p.y, sine * p.x + cosine * p.y};
}

bool is_regular(const Iris& iris) { return iris.asymmetry == 0.0 && iris.blade_offset.empty(); }

double edge_offset(const Iris& iris, int blade) {
  const auto k = static_cast<std::size_t>(blade);
  const double given = k < iris.blade_offset.size() ? iris.blade_offset[k] : 0.0;
  if (iris.asymmetry == 0.0) return given;
  const std::uint64_t bits = split_mix((std::uint64_t{iris.seed} << 32) + kSplitMixIncrement * (k + 1));
  return given + iris.asymmetry * (2.0 * unit_interval(bits) - 1.0);
}

IrisBound edge_bound(const Iris& iris, double normal_rad, double offset) {
  const double half_sector = std::numbers::pi / iris.blades;
  const double apothem = iris.blade_radius * std::cos(half_sector);
  const Vec2 normal{std::cos(normal_rad), std::sin(normal_rad)};
  IrisBound bound{normal, apothem * (1.0 + offset), {}};
  if (iris.curvature < kStraight) return bound;
  // The arc through both corners, then moved along its normal.
  const double half_chord = iris.blade_radius * std::sin(half_sector);
  bound.radius = iris.blade_radius / std::min(iris.curvature, 1.0);
  bound.centre = normal * (bound.apothem - std::sqrt(bound.radius * bound.radius - half_chord * half_chord));
  return bound;
}

}  // namespace contrejour::inline internal

namespace contrejour {

double iris_distance(const Iris& iris, Vec2 point) {
  if (iris.field) return iris.field->distance(rotated(point, -iris.rotation_rad));
  if (blade_count(iris) == 0) return length(point) - 1.0;
  if (is_regular(iris)) {
    const double blades = folded_distance(iris, point);
    // Straight blades that reach the rim leave nothing for the rim to cut.
    return iris.blade_radius <= 1.0 ? blades : std::max(blades, length(point) - 1.0);
  }
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  double worst = length(point) - 1.0;
  for (int k = 0; k < iris.blades; ++k)
    worst =
        std::max(worst, edge_bound(iris, iris.rotation_rad + (k + 0.5) * sector, edge_offset(iris, k)).distance(point));
  return worst;
}

double iris_slope_spread_rad(const Iris& iris) {
  if (iris.field || blade_count(iris) == 0 || iris.curvature < kStraight) return 0.0;
  return iris.slope_spread * 2.0 * std::asin(std::min(iris.curvature, 1.0) * std::sin(std::numbers::pi / iris.blades));
}

double iris_transmittance(const Iris& iris, Vec2 point, double width) {
  if (iris_distance(iris, point) > 0.0) return 0.0;
  return iris.field ? iris.field->transmittance(rotated(point, -iris.rotation_rad), width) : 1.0;
}

double iris_area_fraction(const Iris& iris) {
  if (iris.field) return iris.field->area() / std::numbers::pi;
  if (blade_count(iris) == 0) return 1.0;
  const double sector = 2.0 * std::numbers::pi / iris.blades;
  if (is_regular(iris) && iris.curvature < kStraight && iris.blade_radius <= 1.0)
    return iris.blade_radius * iris.blade_radius * std::sin(sector) / sector;
  return IrisOpening(iris).area() / std::numbers::pi;
}

}  // namespace contrejour
