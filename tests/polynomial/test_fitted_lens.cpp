// SPDX-License-Identifier: Apache-2.0
// Rays that are evaluated in packets against evaluate(), which sums Chebyshev polynomials one point at a time in
// double.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <doctest/doctest.h>

#include "polynomial/fitted_lens.h"
#include "polynomial/zone_rays.h"
#include "render/pupils/fitted_pupil.h"

using namespace contrejour;
using polynomial::FittedLens;

namespace {

LensState tessar() {
  const auto lens = configure_lens(*find_lens("tessar"));
  REQUIRE(lens.has_value());
  return *lens;
}

const std::shared_ptr<const LensPolynomials>& one_side_fit() {
  static const std::shared_ptr<const LensPolynomials> made = [] {
    auto fitted = fit_polynomials(tessar(), {.max_halvings = 1, .scope = GhostScope::OneSideOfStop});
    REQUIRE(fitted.has_value());
    return std::make_shared<const LensPolynomials>(std::move(*fitted));
  }();
  return made;
}

// A light at a tangent from the axis, not along an axis of the lens.
LightFrame light_at(double field) { return LightFrame(LightSource(normalized({0.6 * field, 0.8 * field, 1.0}))); }

struct Evaluated {
  std::vector<float> x_mm, y_mm, sensor_x, sensor_y, transmission, height, rims;
  std::array<std::vector<float>, kMaxStopCrossings> stop_x, stop_y;

  explicit Evaluated(std::size_t count) {
    for (auto* values : {&x_mm, &y_mm, &sensor_x, &sensor_y, &transmission, &height}) values->resize(count);
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c) stop_x[c].resize(count), stop_y[c].resize(count);
  }
  TracedArrays arrays(std::size_t rim_count) {
    rims.resize(rim_count * x_mm.size());
    TracedArrays out{sensor_x.data(), sensor_y.data(), transmission.data(), height.data(), {}, {},
                     rims.data(),     x_mm.size()};
    for (std::size_t c = 0; c < kMaxStopCrossings; ++c)
      out.stop_x[c] = stop_x[c].data(), out.stop_y[c] = stop_y[c].data();
    return out;
  }
};

// Points of the bounds of a zone at a field, relative to its lower left corner; 61, which fill no whole packets.
Evaluated points_within(const PolynomialBounds& bounds) {
  Evaluated points(61);
  for (std::size_t k = 0; k < points.x_mm.size(); ++k) {
    const double t = static_cast<double>(k) / 60.0;
    points.x_mm[k] = static_cast<float>((static_cast<double>(bounds.high_x_mm) - bounds.low_x_mm) * t);
    points.y_mm[k] = static_cast<float>(bounds.half_y_mm * (1.0 + std::sin(5.0 * t)));
  }
  return points;
}

}  // namespace

TEST_CASE("packets give the values of evaluate(), for a smaller stop and another entrance plane") {
  const FittedLens lens(one_side_fit());
  constexpr double kPlane_mm = 2.5, kSmaller = 0.4, kLambda_nm = 487.0;
  int compared = 0;
  for (const GhostPolynomials& ghost : one_side_fit()->ghosts) {
    for (const PolynomialZone& zone : ghost.zones) {
      if (zone.state != PolynomialZone::State::Fitted) continue;
      const double field = std::lerp(zone.field_low, zone.field_high, 0.63);
      const PolynomialBounds bounds = polynomial::bounds_between(zone, field);
      if (!polynomial::has_light(bounds)) continue;
      const LightFrame light = light_at(field);
      const double to_plane_mm = kPlane_mm - one_side_fit()->entrance_z_mm;
      const auto fitted =
          lens.find({ghost.ghost, light, kPlane_mm, kSmaller * one_side_fit()->stop_radius_mm, 400.0, 700.0});
      REQUIRE(fitted != nullptr);
      const auto source = fitted->at(kLambda_nm);
      CHECK(source->surfaces() == 0);
      CHECK(source->rims() == zone.rims.size());
      Evaluated points = points_within(bounds);
      const Vec2 corner{bounds.low_x_mm + field * to_plane_mm, -bounds.half_y_mm};
      source->rays(corner, PacketPrecision::Float, points.x_mm.data(), points.y_mm.data(), points.x_mm.size(),
                   points.arrays(zone.rims.size()));
      std::vector<float> alone(points.x_mm.size());
      source->transmissions(corner, PacketPrecision::Float, points.x_mm.data(), points.y_mm.data(), alone.size(),
                            alone.data());
      CHECK(alone == points.transmission);
      const double largest = *std::ranges::max_element(points.transmission);
      for (std::size_t k = 0; k < points.x_mm.size(); ++k) {
        const Vec2 at{bounds.low_x_mm + points.x_mm[k], -bounds.half_y_mm + points.y_mm[k]};
        const PolynomialRay ray = evaluate(*one_side_fit(), zone, field, at, kLambda_nm);
        // Far outside the light values are so large that float rounds them more coarsely.
        if (std::max(ray.relative_height, length(ray.stop[0])) > 1.2) continue;
        CHECK(length(Vec2{points.sensor_x[k], points.sensor_y[k]} - ray.sensor_mm) < 0.02 * one_side_fit()->pixel_mm);
        CHECK(length(Vec2{points.stop_x[0][k], points.stop_y[0][k]} * kSmaller - ray.stop[0]) < 3e-5);
        CHECK(std::abs(points.height[k] - std::max(ray.relative_height, length(ray.stop[0]) / 1.03)) < 1e-4);
        if (std::max(ray.relative_height, length(ray.stop[0])) <= 1.0)
          CHECK(std::abs(points.transmission[k] - std::max(ray.transmittance, 0.0)) < 1e-4 * largest);
        ++compared;
      }
    }
  }
  CHECK(compared > 100);
}

TEST_CASE("pupils of fitted ghosts contain all light at any stop, and little else") {
  const FittedLens lens(one_side_fit());
  constexpr std::array kLambda_nm{450.0, 550.0, 650.0};
  constexpr int kSide = 80;
  for (const double opening : {1.0, 0.5, 0.1}) {
    int lit = 0;
    double boxes_mm2 = 0.0, light_mm2 = 0.0;
    for (const GhostPolynomials& ghost : one_side_fit()->ghosts) {
      const PolynomialZone* const zone = find_zone(ghost, 0.13);
      if (zone == nullptr || zone->state != PolynomialZone::State::Fitted) continue;
      const LightFrame light = light_at(0.13);
      const auto fitted = lens.find({ghost.ghost, light, one_side_fit()->entrance_z_mm,
                                     opening * one_side_fit()->stop_radius_mm, kLambda_nm[0], kLambda_nm[2]});
      REQUIRE(fitted != nullptr);
      const std::vector<Rectangle> boxes = find_fitted_pupil(*fitted, kLambda_nm);
      for (const Rectangle& box : boxes) boxes_mm2 += area_of(box);
      const Rectangle half = fitted->region();
      for (int k = 0; k < kSide * kSide; ++k) {
        const Vec2 at{std::lerp(half.low.x, half.high.x, (k % kSide + 0.5) / kSide),
                      std::lerp(0.0, half.high.y, (k / kSide + 0.5) / kSide)};
        const PolynomialRay ray = evaluate(*one_side_fit(), *zone, 0.13, at, 550.0);
        if (ray.relative_height > 1.0 || length(ray.stop[0]) > opening) continue;
        ++lit;
        light_mm2 += 2.0 * area_of(half) / (kSide * kSide);
        CHECK(std::ranges::any_of(boxes, [&](const Rectangle& b) {
          return at.x >= b.low.x && at.x <= b.high.x && at.y >= b.low.y && at.y <= b.high.y;
        }));
      }
    }
    CHECK(lit > 10);
    CHECK(boxes_mm2 < 4.0 * light_mm2);
  }
}

TEST_CASE("rays must be traced where the fit does not hold") {
  const FittedLens lens(one_side_fit());
  const double widest = one_side_fit()->stop_radius_mm, plane = one_side_fit()->entrance_z_mm;
  const LightFrame inside = light_at(0.1);
  const auto fitted = [&](const Ghost& ghost, const LightFrame& light, double stop_mm, double from_nm, double to_nm) {
    return lens.find({ghost, light, plane, stop_mm, from_nm, to_nm}) != nullptr;
  };
  const auto known = std::ranges::find_if(one_side_fit()->ghosts, [&](const GhostPolynomials& ghost) {
    return fitted(ghost.ghost, inside, widest, 400.0, 700.0);
  });
  REQUIRE(known != one_side_fit()->ghosts.end());
  CHECK_FALSE(fitted(known->ghost, light_at(1.01 * one_side_fit()->max_field), widest, 400.0, 700.0));
  CHECK_FALSE(fitted(known->ghost, inside, 1.2 * widest, 400.0, 700.0));
  CHECK_FALSE(fitted(known->ghost, inside, widest, 350.0, 700.0));
  CHECK_FALSE(fitted(known->ghost, inside, widest, 400.0, 900.0));
  CHECK_FALSE(fitted(known->ghost, LightFrame(LightSource(normalized({0.1, 0.0, 1.0}), 1000.0)), widest, 400.0, 700.0));
  CHECK_FALSE(fitted(known->ghost, LightFrame(inside.source, false), widest, 400.0, 700.0));
  CHECK_FALSE(fitted(Ghost{1, 8}, inside, widest, 400.0, 700.0));  // not on one side of the stop
  for (const GhostPolynomials& ghost : one_side_fit()->ghosts)
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Traced)
        CHECK_FALSE(fitted(ghost.ghost, light_at(0.5 * (zone.field_low + zone.field_high)), widest, 400.0, 700.0));
}
