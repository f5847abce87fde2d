// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/rims.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace contrejour::inline internal {
namespace {

// Distance of the sphere from its vertex plane at height h, |c| h <= 1.
double sag_mm(double curvature_per_mm, double h_mm) {
  const double ch = curvature_per_mm * h_mm;
  return ch * h_mm / (1.0 + std::sqrt(std::max(0.0, 1.0 - ch * ch)));
}

// The gap is monotonic in height, since a sphere's slope is monotonic in its curvature, and at the axis it is the
// thickness: only the rim must be checked.
Gap gap_of_spheres(const Surface& front, const Surface& back, double thickness_mm, double height_mm) {
  return {thickness_mm + sag_mm(back.curvature_per_mm, height_mm) - sag_mm(front.curvature_per_mm, height_mm),
          height_mm};
}

// Height of a surface of any shape, decentred, and tilted by so small an angle that the sag's foot point stays.
std::optional<double> height_mm(const Surface& s, Vec2 at_mm) {
  const Vec2 from = at_mm - Vec2{s.pose.shift_mm.x, s.pose.shift_mm.y};
  const auto point = surface_at(s.curvature_per_mm, s.shape, from);
  if (!point) return std::nullopt;
  const Vec3 axis = s.pose.axis;
  return s.pose.shift_mm.z + point->sag_mm - (axis.x * from.x + axis.y * from.y) / axis.z;
}

constexpr int kSpokes = 24;

// The number of the 24 spokes that symmetry leaves, from x towards y: one for surfaces of revolution, a quarter of a
// turn for surfaces symmetric about both axes.
int spokes_of(const Surface& front, const Surface& back) {
  if (!(front.pose == SurfacePose{}) || !(back.pose == SurfacePose{})) return kSpokes;
  if (front.shape.has_axial_symmetry() && back.shape.has_axial_symmetry()) return 1;
  return front.shape.rotation_rad == 0.0 && back.shape.rotation_rad == 0.0 ? kSpokes / 4 + 1 : kSpokes;
}

// For other shapes and for tilted surfaces the smallest gap may be anywhere within the rims.
Gap gap_of_any(const Surface& front, const Surface& back, double thickness_mm, double rim_mm) {
  constexpr int kRings = 32;
  const int spokes = spokes_of(front, back);
  Gap smallest{thickness_mm, 0.0};
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int spoke = 0; spoke < spokes; ++spoke) {
      const double r_mm = rim_mm * ring / kRings;
      const double angle = 2.0 * std::numbers::pi * spoke / kSpokes;
      const Vec2 at{r_mm * std::cos(angle), r_mm * std::sin(angle)};
      const auto from = height_mm(front, at), to = height_mm(back, at);
      if (!from || !to) continue;
      const double gap_mm = thickness_mm + *to - *from;
      if (gap_mm < smallest.gap_mm) smallest = {gap_mm, r_mm};
    }
  }
  return smallest;
}

bool is_plain(const Surface& s) { return s.shape.is_sphere() && s.pose == SurfacePose{}; }

}  // namespace

Gap smallest_gap(const Surface& front, const Surface& back, double thickness_mm, double height_mm) {
  return is_plain(front) && is_plain(back) ? gap_of_spheres(front, back, thickness_mm, height_mm)
                                           : gap_of_any(front, back, thickness_mm, height_mm);
}

bool reaches(const Surface& surface, double height_mm) {
  if (surface.shape.is_sphere()) return std::abs(surface.curvature_per_mm) * height_mm <= 1.0;
  constexpr int kRings = 32;  // at all heights: a toroid with a polynomial may have gaps
  for (int ring = 1; ring <= kRings; ++ring)
    if (!sag_range(surface.curvature_per_mm, surface.shape, height_mm * ring / kRings)) return false;
  return true;
}

void for_each_neighbours(std::span<const Surface> surfaces, std::span<const double> thickness_mm,
                         const std::function<bool(std::size_t, std::size_t, double)>& body) {
  std::optional<std::size_t> front;
  double gap_mm = 0.0;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (surfaces[i].kind == SurfaceKind::Refracting) {
      if (front && !body(*front, i, gap_mm)) return;
      front = i;
      gap_mm = 0.0;
    }
    gap_mm += thickness_mm[i];
  }
}

std::vector<std::vector<double>> thicknesses_of(const Prescription& lens) {
  std::vector<double> own;
  for (const Surface& surface : lens.surfaces) own.push_back(surface.thickness_mm);
  if (lens.zoom.empty()) return {own};
  std::vector<std::vector<double>> all;
  for (const ZoomPosition& position : lens.zoom) {
    for (const auto& [index, gap_mm] : position.thickness_mm) own.at(static_cast<std::size_t>(index)) = gap_mm;
    all.push_back(own);
  }
  return all;
}

}  // namespace contrejour::inline internal
