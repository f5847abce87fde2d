// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "contrejour/expert/trace.h"

namespace contrejour {
namespace {

constexpr int kRings = 64;          // of the cap, from vertex to rim
constexpr double kMargin = 1e-3;    // of the semi-diameter: discretisation error of the rings

double sag(double curvature, double r) {
  const double cr = curvature * r;
  return curvature * r * r / (1.0 + std::sqrt(std::max(0.0, 1.0 - cr * cr)));
}

// The lowest and highest sag on a circle.
SagRange heights(const SurfaceState& s, double r) {
  if (!s.shape.is_sphere()) return sag_range(s.curvature_per_mm, s.shape, r).value_or(SagRange{});
  const double height_mm = sag(s.curvature_per_mm, r);
  return {height_mm, height_mm};
}

// The cap's lowest point; a sphere's is at its vertex or its rim.
double lowest_mm(const SurfaceState& s) {
  double lowest = std::min(0.0, heights(s, s.semi_diameter_mm).low_mm);
  for (int k = 1; !s.shape.is_sphere() && k < kRings; ++k)
    lowest = std::min(lowest, heights(s, s.semi_diameter_mm * k / kRings).low_mm);
  return lowest;
}

struct Circle {
  Vec2 centre;
  double radius = 0;
};

// Upper bounds of the front's displacement by decentre and tilt, sideways and forwards.
double sideways_displacement_mm(const SurfaceState& first) { return length(first.pose.shift_mm); }
double forward_displacement_mm(const SurfaceState& first) {
  return sideways_displacement_mm(first) +
         2.0 * first.semi_diameter_mm * std::hypot(first.pose.axis.x, first.pose.axis.y);
}

// The shadow of the circle about the axis at height z on a plane `to_plane_mm` behind it: shifted, and enlarged for a
// light at a finite distance.
Circle shadow(const LightSource& source, double z_mm, double radius_mm, double to_plane_mm) {
  if (source.is_distant()) {
    const Vec2 slope{source.direction.x / source.direction.z, source.direction.y / source.direction.z};
    return {slope * to_plane_mm, radius_mm};
  }
  const Vec3 from = source.point_mm();
  const double further = to_plane_mm / (z_mm - from.z);
  return {Vec2{from.x, from.y} * -further, radius_mm * (1.0 + further)};
}

}  // namespace

Result<void> check_source(const LensState& lens, const LightSource& source) {
  const Vec3 d = source.direction;
  const auto refuse = [](std::string why) { return failure(ErrorCode::InvalidArgument, std::move(why)); };
  if (!std::isfinite(d.x + d.y + d.z) || !(d.z > 0.0)) return refuse("the light is beside or behind the camera");
  if (!(source.distance_mm > 0.0))
    return refuse(fmt::format("a light cannot be at a distance of {} mm; give more than 0", source.distance_mm));
  if (lens.surfaces.empty()) return refuse("the lens state has no surfaces; make it with configure_lens()");
  const SurfaceState& first = lens.surfaces.front();
  const double front_mm = lowest_mm(first) + first.z_mm - forward_displacement_mm(first);
  if (!source.is_distant() && !(source.point_mm().z <= front_mm - kNearestLight_mm))
    return refuse(
        fmt::format("a light {} mm from the first surface is not in front of all of the lens; give it {:.4g} mm "
                    "along the axis or more",
                    source.distance_mm, kNearestLight_mm - front_mm));
  return {};
}

// For oblique light the shadow of surface 1's cap can extend beyond that of its rim if the surface bulges: each ring of
// the cap is projected along the light onto the plane of the rim.
EntranceWindow entrance_window(const LensState& lens, const LightSource& source) {
  if (lens.surfaces.empty()) return {};
  const SurfaceState& first = lens.surfaces.front();
  const double rim = first.semi_diameter_mm;
  EntranceWindow window;
  const SagRange rim_heights = heights(first, rim);
  window.z_mm = first.z_mm +
                (first.shape.is_sphere() ? rim_heights.low_mm : std::midpoint(rim_heights.low_mm, rim_heights.high_mm));
  window.min_mm = {-rim, -rim};
  window.max_mm = {rim, rim};
  for (int k = 0; k <= kRings; ++k) {
    const double r = rim * k / kRings;
    const SagRange at_ring = heights(first, r);
    for (const double height_mm : {at_ring.low_mm, at_ring.high_mm}) {
      const double z_mm = first.z_mm + height_mm;
      const Circle ring = shadow(source, z_mm, r, window.z_mm - z_mm);
      window.min_mm = {std::min(window.min_mm.x, ring.centre.x - ring.radius),
                       std::min(window.min_mm.y, ring.centre.y - ring.radius)};
      window.max_mm = {std::max(window.max_mm.x, ring.centre.x + ring.radius),
                       std::max(window.max_mm.y, ring.centre.y + ring.radius)};
    }
  }
  double extent = rim;
  if (!source.is_distant()) {
    const Vec2 half = (window.max_mm - window.min_mm) * 0.5;
    extent = std::max({rim, half.x, half.y});
  }
  double spare_mm = kMargin * extent;
  // A displaced cap shifts the shadow sideways by its decentre, and by the slope of the light times its displacement
  // forwards; the slope is estimated from the window's size.
  if (!first.is_centred()) {
    const double slope = std::hypot(window.max_mm.x - window.min_mm.x, window.max_mm.y - window.min_mm.y) / (2.0 * rim);
    spare_mm += sideways_displacement_mm(first) + forward_displacement_mm(first) * slope;
  }
  const Vec2 margin{spare_mm, spare_mm};
  window.min_mm = window.min_mm - margin;
  window.max_mm = window.max_mm + margin;
  return window;
}

}  // namespace contrejour
