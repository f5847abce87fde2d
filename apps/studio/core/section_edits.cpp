// SPDX-License-Identifier: Apache-2.0
#include "studio/core/section_edits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "studio/core/prescription_table.h"

namespace contrejour::studio {
namespace {

constexpr double kFlattest_mm = 1e-4;  // of a rim's sag: a flatter surface is a plane

bool is_zoom_gap(const Prescription& lens, std::size_t row) {
  return std::ranges::any_of(lens.zoom, [&](const ZoomPosition& position) {
    return std::ranges::any_of(position.thickness_mm,
                               [&](const auto& gap) { return gap.first == static_cast<int>(row); });
  });
}

double sag_of_sphere(double curvature_per_mm, double height_mm) {
  const double c = curvature_per_mm, h = height_mm;
  return c * h * h / (1 + std::sqrt(std::fmax(0.0, 1 - c * c * h * h)));
}

Result<Prescription> with_vertex(const Prescription& lens, std::size_t row, double along_mm) {
  if (row == 0) return invalid_argument("the first surface stays: all distances count from it");
  const bool is_last = row + 1 == lens.surfaces.size();
  if (is_zoom_gap(lens, row - 1) || is_zoom_gap(lens, row))
    return invalid_argument("this gap is another one at each focal length; type it in the lens file");
  const auto moved = [&](std::size_t k, double by) {
    return fmt::format("{:.4f}", lens.surfaces[k].thickness_mm + by);
  };
  auto before = with_cell(lens, row - 1, LensColumn::Thickness, moved(row - 1, along_mm));
  if (!before || is_last) return before;
  return with_cell(*before, row, LensColumn::Thickness, moved(row, -along_mm));
}

// The radius of a sphere through the vertex and a rim of this height: R = (h^2 + s^2) / (2 s).
Result<Prescription> with_rim(const Prescription& lens, std::size_t row, double along_mm) {
  const Surface& surface = lens.surfaces[row];
  if (surface.kind == SurfaceKind::Stop) return invalid_argument("the f-number opens and closes the stop");
  const double h = surface.semi_diameter_mm, sag = sag_of_sphere(surface.curvature_per_mm, h) + along_mm;
  if (std::fabs(sag) < kFlattest_mm) return with_cell(lens, row, LensColumn::Radius, "inf");
  return with_cell(lens, row, LensColumn::Radius, fmt::format("{:.4f}", (h * h + sag * sag) / (2 * sag)));
}

}  // namespace

SurfaceGrip grip_at(const Surface& surface, double height_mm) {
  const bool is_stop = surface.kind == SurfaceKind::Stop;
  return is_stop || std::fabs(height_mm) < 0.5 * surface.semi_diameter_mm ? SurfaceGrip::Vertex : SurfaceGrip::Rim;
}

Result<Prescription> with_surface_dragged(const Prescription& lens, std::size_t row, SurfaceGrip grip,
                                          double along_mm) {
  if (row >= lens.surfaces.size()) return invalid_argument("there is no such surface");
  return grip == SurfaceGrip::Vertex ? with_vertex(lens, row, along_mm) : with_rim(lens, row, along_mm);
}

}  // namespace contrejour::studio
