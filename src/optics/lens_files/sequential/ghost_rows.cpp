// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/ghost_rows.h"

#include <algorithm>
#include <array>
#include <numbers>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens/ghost_walk.h"

namespace contrejour::inline internal {
namespace {

bool is_path(const LensState& lens, const Ghost& ghost) {
  const auto turns = [&](int surface) {
    return surface >= 1 && surface <= static_cast<int>(lens.surfaces.size()) && surface != lens.stop_index + 1;
  };
  const bool two = turns(ghost.i) && turns(ghost.j) && ghost.i < ghost.j;
  if (!ghost.reflects_four_times()) return two;
  return two && turns(ghost.k) && turns(ghost.l) && ghost.k < ghost.l && ghost.l > ghost.i;
}

Surface row_of(const LensState& lens, const SurfaceState& s, const Glass& after) {
  Surface row;
  row.kind = s.kind == SurfaceKind::Stop ? SurfaceKind::Stop : SurfaceKind::Refracting;
  row.curvature_per_mm = s.curvature_per_mm;
  row.semi_diameter_mm = s.kind == SurfaceKind::Stop ? lens.stop_radius_mm : s.semi_diameter_mm;
  row.glass_after = after;
  row.coating = s.coating;
  row.shape = s.shape;
  row.pose = s.pose;
  row.aperture = s.aperture;
  row.obscuration = s.obscuration;
  return row;
}

}  // namespace

Result<WritableDesign> ghost_rows(const LensState& lens, const Ghost& ghost) {
  if (!is_path(lens, ghost))
    return failure(ErrorCode::InvalidArgument, fmt::format("there is no ghost {} in this lens", ghost_name(ghost)));
  if (ghost.order != std::array<int, 2>{0, 0})
    return failure(ErrorCode::Unsupported,
                   fmt::format("ghost {}: an order of diffraction at the sensor cannot be written", ghost_name(ghost)));
  WritableDesign out;
  std::vector<double> z_mm;
  bool has_stop = false;
  const auto add = [&](int k, const Glass& after, bool is_mirror) {
    const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(k)];
    Surface row = row_of(lens, s, after);
    if (row.kind == SurfaceKind::Stop && std::exchange(has_stop, true)) row.kind = SurfaceKind::Refracting;
    out.lens.surfaces.push_back(std::move(row));
    out.is_mirror.push_back(is_mirror);
    z_mm.push_back(s.z_mm);
  };
  walk_surfaces(
      lens, ghost,
      [&](int k, int direction) {
        const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(k)];
        add(k, direction > 0 ? s.after : s.before, false);
      },
      [&](int k, int direction, std::array<int, 2>) {
        const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(k)];
        add(k, direction > 0 ? s.before : s.after, true);
      });
  for (std::size_t k = 0; k + 1 < z_mm.size(); ++k) out.lens.surfaces[k].thickness_mm = z_mm[k + 1] - z_mm[k];
  out.sensor_mm = lens.sensor_z_mm - z_mm.back();
  out.lens.surfaces.back().thickness_mm = out.sensor_mm;
  out.lens.name = fmt::format("{}, ghost {}", lens.name, ghost_name(ghost));
  out.lens.f_number = lens.f_number;
  out.lens.sensor_width_mm = lens.sensor_width_mm;
  out.lens.sensor_height_mm = lens.sensor_height_mm;
  out.lens.sensor_distance_mm = out.sensor_mm;
  out.lens.stated.wavelength_nm = lens.design_wavelength_nm;
  const FirstOrder first = first_order(lens, lens.design_wavelength_nm);
  out.pupil_mm = first.entrance_pupil_diameter_mm;
  out.field_deg = first.half_field_rad * 180.0 / std::numbers::pi;
  return out;
}

}  // namespace contrejour::inline internal
