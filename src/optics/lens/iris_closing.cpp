// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/iris_closing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "aperture/iris_blades.h"

namespace contrejour::inline internal {
namespace {

constexpr double kMaxAsymmetry = 0.5;
constexpr double kMaxSlopeSpread = 0.5;
constexpr double kMaxRotation_rad = 1e6;  // beyond, angles lose visible accuracy
constexpr double kOpen = 1e-9;        // relative to the hole's area: a smaller difference counts as wide open
constexpr double kSameRadius = 1e-9;  // relative: the opening's reach is the rim, or its corners' circle
constexpr int kBisections = 60;       // to the last bits of the blades' position
constexpr double kFarthestBlades = 1e6;  // hole radii

double area_at(Iris iris, double blade_radius) {
  iris.blade_radius = blade_radius;
  return IrisOpening(iris).area();
}

// The blade radius, relative to the hole's, at which the opening has this area; the hole has radius 1.
double blade_radius_of(const Iris& iris, double area) {
  double low = 0.0;
  double high = 1.0;
  while (high < kFarthestBlades && area_at(iris, high) < area) {
    low = high;
    high *= 2.0;
  }
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (low + high);
    (area_at(iris, middle) < area ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

ClosedIris close_iris(const Iris& iris, double round_radius_mm, double hole_radius_mm) {
  ClosedIris closed{iris, round_radius_mm};
  if (iris.blades < 3) return closed;
  const double area_fraction = std::pow(round_radius_mm / hole_radius_mm, 2.0);
  if (area_fraction >= 1.0 - kOpen) {
    closed.iris.blades = 0;
    return closed;
  }
  const double blade_radius = blade_radius_of(iris, std::numbers::pi * area_fraction);
  closed.iris.blade_radius = blade_radius;
  double outer_radius = IrisOpening(closed.iris).outer_radius();
  for (const double usual : {1.0, blade_radius}) {
    if (std::abs(outer_radius / usual - 1.0) < kSameRadius) outer_radius = usual;
  }
  closed.iris.blade_radius = blade_radius / outer_radius;
  closed.stop_radius_mm = hole_radius_mm * outer_radius;
  return closed;
}

Result<void> check_iris(const Iris& iris) {
  const auto refused = [](const std::string& what) { return failure(ErrorCode::InvalidArgument, what); };
  if (iris.field && iris.blades >= 3) return refused("an iris has either blades or a picture's shape; choose one");
  if (iris.blades > kMaxBlades)
    return refused(fmt::format("an iris of {} blades; there may be {}", iris.blades, kMaxBlades));
  if (!(std::abs(iris.rotation_rad) <= kMaxRotation_rad))
    return refused(fmt::format("an iris cannot be turned by {} radians", iris.rotation_rad));
  if (!(iris.curvature >= 0.0 && iris.curvature <= 1.0))
    return refused(
        fmt::format("blades cannot have the curvature {}; choose 0 (straight) to 1 (round)", iris.curvature));
  if (!(iris.blade_radius > 0.0) || !std::isfinite(iris.blade_radius))
    return refused(fmt::format("blades cannot stand {} stop radii out; choose more than 0", iris.blade_radius));
  if (!(iris.asymmetry >= 0.0 && iris.asymmetry <= kMaxAsymmetry))
    return refused(fmt::format("blades cannot have the asymmetry {}; choose 0 to {}", iris.asymmetry, kMaxAsymmetry));
  if (!(iris.slope_spread >= 0.0 && iris.slope_spread <= kMaxSlopeSpread))
    return refused(fmt::format("blades' slopes cannot spread by {} of their bend; choose 0 to {}", iris.slope_spread,
                               kMaxSlopeSpread));
  if (!std::all_of(iris.blade_offset.begin(), iris.blade_offset.end(), [](double o) { return std::isfinite(o); }))
    return refused("a blade's offset is not finite");
  if (IrisOpening(iris).closed()) return refused("these blades let nothing through; move them outwards");
  return {};
}

}  // namespace contrejour::inline internal
