// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "cli/lens_info_report.h"
#include "cli/text_table.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

// The shape, its radius in the x-z section if that differs, the aperture and the obscuration, and whether it is
// centred.
std::string shape_text(const SurfaceState& s) {
  std::string text = shape_name(s.curvature_per_mm, s.shape);
  if (!s.shape.has_axial_symmetry()) {
    const double c = s.shape.curvature_x_per_mm;
    text += c == 0.0 ? ", x plane" : fmt::format(", x {:.4f}", 1.0 / c);
  }
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : ", ") + more; };
  if (s.aperture.kind != ApertureKind::Disc)
    add(fmt::format("{} {:.4g} x {:.4g}", kind_name(s.aperture.kind), 2.0 * s.aperture.half_mm.x,
                    2.0 * s.aperture.half_mm.y));
  if (s.obscuration.any())
    add(fmt::format("obscured {:.4g} x {:.4g}", 2.0 * s.obscuration.half_mm.x, 2.0 * s.obscuration.half_mm.y));
  if (!s.is_centred()) add("decentred or tilted");
  return text;
}

std::string surfaces_text(const LensInfo& info) {
  const auto is_special = [](const SurfaceState& s) {
    return !s.shape.is_sphere() || !s.is_centred() || s.aperture.kind != ApertureKind::Disc || s.obscuration.any();
  };
  const bool all_spheres = std::none_of(info.state.surfaces.begin(), info.state.surfaces.end(), is_special);
  std::vector<std::string> headings{"surface",       "radius mm", "thickness mm", "semi-diameter mm",
                                    "<glass behind", "n",         "<coating"};
  if (!all_spheres) headings.emplace_back("<shape");
  TextTable table(headings);
  for (std::size_t k = 0; k < info.state.surfaces.size(); ++k) {
    const SurfaceState& s = info.state.surfaces[k];
    const bool is_stop = s.kind == SurfaceKind::Stop;
    const double semi_mm = is_stop ? info.state.stop_radius_mm : s.semi_diameter_mm;
    const std::string radius = s.curvature_per_mm == 0.0 ? "plane" : fmt::format("{:.4f}", 1.0 / s.curvature_per_mm);
    std::vector<std::string> row{fmt::format("{}", k + 1),
                                 s.kind == SurfaceKind::Refracting ? radius : kind_name(s.kind),
                                 fmt::format("{:.4f}", thickness_mm(info.state, k)),
                                 has_real_rim(info.state, s) ? fmt::format("{:.3f}", semi_mm) : "",
                                 glass_name(s.after),
                                 fmt::format("{:.6f}", refractive_index(s.after, info.lambda_nm)),
                                 is_stop ? "" : describe(s.coating)};
    if (!all_spheres) row.push_back(shape_text(s));
    table.add(std::move(row));
  }
  return table.text();
}

std::string figures_text(const LensInfo& info) {
  const FirstOrder& f = info.figures;
  TextTable table({"<", "", "<"});
  const auto add = [&](const std::string& name, double value, const std::string& unit) {
    table.add({name, fmt::format("{:.4f}", value), unit});
  };
  add("focal length", f.focal_length_mm, "mm");
  const bool is_anamorphic = f.focal_length_x_mm != f.focal_length_mm;
  if (is_anamorphic) add("  in the x-z section", f.focal_length_x_mm, "mm");
  add("back focal distance", f.back_focal_distance_mm, "mm from the last surface");
  if (is_anamorphic) add("  in the x-z section", f.back_focal_distance_x_mm, "mm");
  add("front focal distance", f.front_focal_distance_mm, "mm from surface 1");
  add("entrance pupil", f.entrance_pupil_position_mm, "mm from surface 1");
  add("  diameter", f.entrance_pupil_diameter_mm, "mm");
  add("exit pupil", f.exit_pupil_position_mm, "mm from the sensor");
  add("  diameter", f.exit_pupil_diameter_mm, "mm");
  add("f-number", f.f_number, "");
  add("sensor", f.sensor_position_mm,
      fmt::format("mm from the last surface, {:g} x {:g} mm", info.state.sensor_width_mm, info.state.sensor_height_mm));
  add("half field", f.half_field_rad / params::kDegree_rad, "degrees, corner");
  const std::string text = table.text();
  return text.substr(text.find('\n') + 1);  // no headings
}

}  // namespace

// In wavelengths, the common unit of wavefront aberrations.
std::string seidel_text(const LensInfo& info) {
  const double per_wave = 1e6 / info.lambda_nm;
  TextTable table({"surface", "S_I", "S_II", "S_III", "S_IV", "S_V", "C_I", "C_II"});
  SeidelSums total;
  const auto add = [&](const std::string& name, const SeidelSums& s) {
    std::vector<std::string> row{name};
    for (const double mm :
         {s.spherical, s.coma, s.astigmatism, s.petzval, s.distortion, s.axial_colour, s.lateral_colour})
      row.push_back(fmt::format("{:.3f}", mm * per_wave));
    table.add(std::move(row));
  };
  for (std::size_t k = 0; k < info.seidel.size(); ++k) {
    total += info.seidel[k];
    if (info.state.surfaces[k].kind == SurfaceKind::Refracting) add(fmt::format("{}", k + 1), info.seidel[k]);
  }
  add("sum", total);
  return "\nSeidel sums in waves, at the f-number and half field above; colour from the F line to the C line\n" +
         table.text();
}

std::string info_text(const LensInfo& info) {
  std::string text = fmt::format("{}\n{}\n", info.lens.name, info.lens.source);
  if (!info.lens.zoom.empty()) {
    text += fmt::format("zoom lens from {:g} to {:g} mm, set to {:.2f} mm\n", info.lens.zoom.front().focal_length_mm,
                        info.lens.zoom.back().focal_length_mm, info.state.focal_length_mm);
  }
  return text + fmt::format("\n{}\nat {:g} nm\n{}", surfaces_text(info), info.lambda_nm, figures_text(info));
}

}  // namespace contrejour::cli
