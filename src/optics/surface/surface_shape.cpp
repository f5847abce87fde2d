// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/surface_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace contrejour {
namespace {

struct Profile {
  double sag = 0, slope = 0;
};

// Sum of powers of h >= 0.
Profile polynomial(const std::vector<double>& powers, double h) {
  Profile p;
  for (auto coefficient = powers.rbegin(); coefficient != powers.rend(); ++coefficient) {
    p.slope = p.slope * h + p.sag;
    p.sag = p.sag * h + *coefficient;
  }
  return {p.sag * h, p.sag + p.slope * h};
}

// c h^2 / (1 + sqrt(1 - (1 + k) c^2 h^2)) + polynomial; none beyond the conic's end.
std::optional<Profile> profile(double c, double conic, const std::vector<double>& powers, double h) {
  const double root_squared = 1.0 - (1.0 + conic) * c * c * h * h;
  if (!(root_squared >= 0.0)) return std::nullopt;
  const double root = std::sqrt(root_squared);
  Profile p = polynomial(powers, h);
  p.sag += c * h * h / (1.0 + root);
  p.slope += c * h / root;
  return p;
}

// z = c_x (x^2 + z^2) / 2 + W, W = w - c_x w^2 / 2: the profile w(y) rotated about the line parallel to y at 1 / c_x.
std::optional<SurfacePoint> toroid_at(double c, const SurfaceShape& shape, Vec2 at) {
  const auto w = profile(c, shape.conic, shape.powers, std::abs(at.y));
  if (!w) return std::nullopt;
  const double cx = shape.curvature_x_per_mm;
  const double twice = cx * at.x * at.x + w->sag * (2.0 - cx * w->sag);
  const double root_squared = 1.0 - cx * twice;
  if (!(root_squared >= 0.0)) return std::nullopt;
  const double root = std::sqrt(root_squared);
  const double side = at.y > 0.0 ? 1.0 : at.y < 0.0 ? -1.0 : 0.0;
  return SurfacePoint{twice / (1.0 + root), {cx * at.x / root, side * w->slope * (1.0 - cx * w->sag) / root}};
}

std::optional<SurfacePoint> biconic_at(double cy, const SurfaceShape& shape, Vec2 at) {
  const double cx = shape.curvature_x_per_mm;
  const double by_x = (1.0 + shape.conic_x) * cx * cx, by_y = (1.0 + shape.conic) * cy * cy;
  const double root_squared = 1.0 - by_x * at.x * at.x - by_y * at.y * at.y;
  if (!(root_squared >= 0.0)) return std::nullopt;
  const double root = std::sqrt(root_squared);
  const double sag = (cx * at.x * at.x + cy * at.y * at.y) / (1.0 + root);
  const auto slope = [&](double curvature, double by, double h) {
    return h * (2.0 * curvature + sag * by / root) / (1.0 + root);
  };
  return SurfacePoint{sag, {slope(cx, by_x, at.x), slope(cy, by_y, at.y)}};
}

std::optional<SurfacePoint> revolution_at(double c, const SurfaceShape& shape, Vec2 at) {
  const double r = length(at);
  const auto p = profile(c, shape.conic, shape.powers, r);
  if (!p) return std::nullopt;
  return SurfacePoint{p->sag, r > 0.0 ? at * (p->slope / r) : Vec2{}};
}

}  // namespace

bool SurfaceShape::is_sphere() const {
  return kind == ShapeKind::Revolution && conic == 0.0 &&
         std::all_of(powers.begin(), powers.end(), [](double a) { return a == 0.0; });
}

std::optional<SurfacePoint> surface_at(double curvature_per_mm, const SurfaceShape& shape, Vec2 at_mm) {
  if (shape.kind == ShapeKind::Revolution) return revolution_at(curvature_per_mm, shape, at_mm);
  const double c = std::cos(shape.rotation_rad), s = std::sin(shape.rotation_rad);
  const Vec2 own{c * at_mm.x + s * at_mm.y, c * at_mm.y - s * at_mm.x};
  auto point = shape.kind == ShapeKind::Toroid ? toroid_at(curvature_per_mm, shape, own)
                                               : biconic_at(curvature_per_mm, shape, own);
  if (point) point->slope = {c * point->slope.x - s * point->slope.y, c * point->slope.y + s * point->slope.x};
  return point;
}

std::optional<SagRange> sag_range(double curvature_per_mm, const SurfaceShape& shape, double radius_mm) {
  constexpr int kSpokes = 16;         // from the shape's own axes, where most shapes have their extremes
  constexpr double kRounding = 1e-12;  // of a hemisphere's rim
  std::optional<SagRange> range;
  const int spokes = shape.has_axial_symmetry() ? 1 : kSpokes;
  for (int spoke = 0; spoke < spokes; ++spoke) {
    const double angle = shape.rotation_rad + 2.0 * std::numbers::pi * spoke / spokes;
    const Vec2 at = Vec2{std::cos(angle), std::sin(angle)} * (radius_mm * (1.0 - kRounding));
    const auto point = surface_at(curvature_per_mm, shape, at);
    if (!point || !std::isfinite(point->sag_mm)) return std::nullopt;
    if (!range) range = SagRange{point->sag_mm, point->sag_mm};
    range = SagRange{std::min(range->low_mm, point->sag_mm), std::max(range->high_mm, point->sag_mm)};
  }
  return range;
}

double vertex_curvature(double curvature_per_mm, const SurfaceShape& shape, Section section) {
  const double of_profile = shape.powers.size() < 2 ? curvature_per_mm : curvature_per_mm + 2.0 * shape.powers[1];
  if (shape.has_axial_symmetry()) return of_profile;
  const double c = std::cos(shape.rotation_rad), s = std::sin(shape.rotation_rad);
  const double across = section == Section::Y ? c : s;  // the section's direction along the shape's own y axis
  return of_profile * across * across + shape.curvature_x_per_mm * (1.0 - across * across);
}

}  // namespace contrejour
