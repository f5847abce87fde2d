// SPDX-License-Identifier: Apache-2.0
#include "drawing/section_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contrejour/expert/clear_aperture.h"

namespace contrejour {
namespace {

// Appends a surface from its rim at `from` (+1 top, -1 bottom) to the other rim.
void append_surface(SectionCurve& curve, const SurfaceState& s, double from) {
  constexpr int kPieces = 64;  // of a surface that is not a sphere: its deviation from them is not visible
  const double h = drawn_height_mm(s);
  if (s.shape.is_sphere()) {
    curve.pieces.push_back({{s.z_mm + sag_mm(s, h), -from * h}, s.curvature_per_mm});
    return;
  }
  for (int k = 1; k <= kPieces; ++k) {
    const double y = from * h * (1.0 - 2.0 * k / kPieces);
    curve.pieces.push_back({{s.z_mm + sag_mm(s, y), y}});
  }
}

// Both faces and the edge between them. Unless the faces cross there, a flat rim at right angles to the axis extends
// the smaller face to the height of the larger, as on a ground lens.
SectionCurve outline_of(const SurfaceState& front, const SurfaceState& rear) {
  const double front_h = drawn_height_mm(front);
  const double rear_h = drawn_height_mm(rear);
  const double front_z = front.z_mm + sag_mm(front, front_h);
  const double rear_z = rear.z_mm + sag_mm(rear, rear_h);
  const double edge_h = std::max(front_h, rear_h);
  SectionCurve curve{{front_z, front_h}, {}};
  append_surface(curve, front, +1.0);
  if (rear_z > front_z) {
    curve.pieces.push_back({{front_z, -edge_h}});
    curve.pieces.push_back({{rear_z, -edge_h}});
  }
  curve.pieces.push_back({{rear_z, -rear_h}});
  append_surface(curve, rear, -1.0);
  if (rear_z > front_z) {
    curve.pieces.push_back({{rear_z, edge_h}});
    curve.pieces.push_back({{front_z, edge_h}});
  }
  curve.pieces.push_back({curve.from_mm});
  return curve;
}

std::vector<SectionElement> elements_of(const LensState& lens) {
  std::vector<SectionElement> elements;
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    const SurfaceState& front = lens.surfaces[k];
    if (front.kind == SurfaceKind::Stop || is_air(front.after)) continue;
    std::size_t next = k + 1;
    while (next < lens.surfaces.size() && lens.surfaces[next].kind == SurfaceKind::Stop) ++next;
    if (next < lens.surfaces.size())
      elements.push_back({k, next, outline_of(front, lens.surfaces[next]), refractive_index(front.after, kLineD_nm)});
  }
  return elements;
}

SectionSurface surface_of(const LensState& lens, std::size_t k) {
  const SurfaceState& s = lens.surfaces[k];
  const double h = drawn_height_mm(s);
  SectionSurface surface{k, {{s.z_mm + sag_mm(s, h), h}, {}}};
  append_surface(surface.curve, s, +1.0);
  return surface;
}

// The obscuration before a surface's middle: the ellipse |A (p - c)| = 1 where it meets x = 0, a quadratic in y.
void append_obscuration(std::vector<SectionCurve>& curves, const SurfaceState& s) {
  if (!s.obscuration.any()) return;
  const Rim rim = rim_of(s.obscuration);
  const Vec2 at = rim.coordinates({0.0, 0.0}), along = rim.coordinates({0.0, 1.0}) - at;
  const double b = dot(at, along), a = dot(along, along), under = b * b - a * (dot(at, at) - 1.0);
  if (!(under > 0.0)) return;
  const double low = (-b - std::sqrt(under)) / a, high = (-b + std::sqrt(under)) / a;
  constexpr int kPieces = 24;
  SectionCurve curve;
  for (int k = 0; k <= kPieces; ++k) {
    const double y = low + (high - low) * k / kPieces;
    const Vec2 point{s.z_mm + sag_mm(s, y), y};
    if (k == 0) {
      curve.from_mm = point;
    } else {
      curve.pieces.push_back({point});
    }
  }
  curves.push_back(std::move(curve));
}

// Appends the arc's points after its beginning.
void append_arc(std::vector<Vec2>& points, Vec2 from, const SectionPiece& arc, double tolerance_mm) {
  const double radius = 1.0 / std::abs(arc.curvature_per_mm);
  const Vec2 chord = arc.to_mm - from;
  const double half = std::min(1.0, 0.5 * length(chord) / radius);
  const double half_angle = std::asin(half);
  const double largest_step = 2.0 * std::acos(std::max(0.0, 1.0 - tolerance_mm / radius));
  const int steps = static_cast<int>(std::clamp(std::ceil(2.0 * half_angle / std::max(largest_step, 1e-3)), 1.0, 4e3));
  // The centre lies on the chord's bisector; `side` is the way to it, to greater z if the curvature is positive.
  Vec2 side = Vec2{-chord.y, chord.x} * (1.0 / std::max(length(chord), 1e-300));
  if ((side.x > 0.0) != (arc.curvature_per_mm > 0.0)) side = side * -1.0;
  const Vec2 centre = (from + arc.to_mm) * 0.5 + side * (radius * std::sqrt(1.0 - half * half));
  const Vec2 begin = from - centre;
  const double turn = cross(begin, arc.to_mm - centre) < 0.0 ? -2.0 * half_angle : 2.0 * half_angle;
  for (int k = 1; k < steps; ++k) {
    const double angle = turn * k / steps, c = std::cos(angle), s = std::sin(angle);
    points.push_back(centre + Vec2{c * begin.x - s * begin.y, s * begin.x + c * begin.y});
  }
  points.push_back(arc.to_mm);
}

}  // namespace

inline namespace internal {

double drawn_height_mm(const SurfaceState& surface) {
  constexpr double kNearlyHalfSphere = 0.9999;
  if (!surface.shape.is_sphere()) return surface.semi_diameter_mm;
  const double curvature = std::abs(surface.curvature_per_mm);
  return std::min(surface.semi_diameter_mm, curvature > 0.0 ? kNearlyHalfSphere / curvature : surface.semi_diameter_mm);
}

double sag_mm(const SurfaceState& surface, double height_mm) {
  const double c = surface.curvature_per_mm;
  if (!surface.shape.is_sphere()) {
    const auto point = surface_at(c, surface.shape, {0.0, height_mm});
    return point ? point->sag_mm : 0.0;
  }
  return c * height_mm * height_mm / (1.0 + std::sqrt(std::max(0.0, 1.0 - c * c * height_mm * height_mm)));
}

void add_shapes(LensSection& section) {
  constexpr double kBlade = 1.25;  // blades reach beyond the stop's largest opening, relative to its radius
  const LensState& lens = section.lens;
  section.elements = elements_of(lens);
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    if (lens.surfaces[k].kind != SurfaceKind::Stop) section.surfaces.push_back(surface_of(lens, k));
    append_obscuration(section.obscurations, lens.surfaces[k]);
  }
  const SurfaceState& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index)];
  section.stop = {stop.z_mm, lens.stop_radius_mm, std::max(kBlade * stop.semi_diameter_mm, lens.stop_radius_mm)};
  section.sensor = {lens.sensor_z_mm, 0.5 * std::hypot(lens.sensor_width_mm, lens.sensor_height_mm)};
}

}  // namespace internal

std::vector<Vec2> polyline(const SectionCurve& curve, double tolerance_mm) {
  std::vector<Vec2> points{curve.from_mm};
  for (const SectionPiece& piece : curve.pieces) {
    const Vec2 from = points.back();
    if (piece.curvature_per_mm == 0.0) {
      points.push_back(piece.to_mm);
    } else {
      append_arc(points, from, piece, std::max(tolerance_mm, 1e-6));
    }
  }
  return points;
}

}  // namespace contrejour
