// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "cli/lens_info_report.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

Json shape_json(double curvature_per_mm, const SurfaceShape& shape) {
  Json out = {{"kind", shape_name(curvature_per_mm, shape)}, {"conic", shape.conic}, {"powers", Json::object()}};
  for (std::size_t k = 0; k < shape.powers.size(); ++k) {
    if (shape.powers[k] != 0.0) out["powers"][fmt::format("{}", k + 1)] = shape.powers[k];
  }
  if (shape.has_axial_symmetry()) return out;
  out["curvature_x_per_mm"] = shape.curvature_x_per_mm;
  out["conic_x"] = shape.conic_x;
  out["turn_deg"] = shape.rotation_rad / params::kDegree_rad;
  return out;
}

// A ClearAperture or an Obscuration.
template <class Part>
Json outline_json(const char* kind, const Part& part) {
  return {{"kind", kind},
          {"half_mm", {part.half_mm.x, part.half_mm.y}},
          {"centre_mm", {part.centre_mm.x, part.centre_mm.y}},
          {"turn_deg", part.rotation_rad / params::kDegree_rad}};
}

Json lens_surfaces_json(const LensInfo& info) {
  Json list = Json::array();
  for (std::size_t k = 0; k < info.state.surfaces.size(); ++k) {
    const SurfaceState& s = info.state.surfaces[k];
    const bool plane = s.curvature_per_mm == 0.0;
    Json row = {{"index", k + 1},
                {"kind", kind_name(s.kind)},
                {"radius_mm", plane ? Json() : Json(1.0 / s.curvature_per_mm)},
                {"curvature_per_mm", s.curvature_per_mm},
                {"thickness_mm", thickness_mm(info.state, k)},
                {"semi_diameter_mm", s.semi_diameter_mm},
                {"glass", glass_name(s.after)},
                {"n_d", refractive_index(s.after, kLineD_nm)},
                {"n", refractive_index(s.after, info.lambda_nm)},
                {"coating", describe(s.coating)}};
    if (!s.shape.is_sphere()) row["shape"] = shape_json(s.curvature_per_mm, s.shape);
    if (s.aperture.kind != ApertureKind::Disc) row["aperture"] = outline_json(kind_name(s.aperture.kind), s.aperture);
    if (s.obscuration.any()) row["obscuration"] = outline_json("ellipse", s.obscuration);
    if (!s.is_centred()) {
      row["decentre_mm"] = {s.pose.shift_mm.x, s.pose.shift_mm.y, s.pose.shift_mm.z};
      row["axis"] = {s.pose.axis.x, s.pose.axis.y, s.pose.axis.z};
    }
    list.push_back(std::move(row));
  }
  return list;
}

Json seidel_json(const std::vector<SeidelSums>& by_surface) {
  const auto row = [](const SeidelSums& s) {
    return Json{{"spherical_mm", s.spherical},          {"coma_mm", s.coma},
                {"astigmatism_mm", s.astigmatism},      {"petzval_mm", s.petzval},
                {"distortion_mm", s.distortion},        {"axial_colour_mm", s.axial_colour},
                {"lateral_colour_mm", s.lateral_colour}};
  };
  Json surfaces = Json::array();
  SeidelSums total;
  for (const SeidelSums& s : by_surface) {
    surfaces.push_back(row(s));
    total += s;
  }
  return {{"sums", row(total)}, {"surfaces", surfaces}};
}

}  // namespace

Json info_json(const LensInfo& info) {
  const FirstOrder& f = info.figures;
  Json zoom = Json::array();
  for (const ZoomPosition& position : info.lens.zoom) zoom.push_back(position.focal_length_mm);
  return {{"name", info.lens.name},
          {"source", info.lens.source},
          {"wavelength_nm", info.lambda_nm},
          {"surfaces", lens_surfaces_json(info)},
          {"stop_index", info.state.stop_index + 1},
          {"stop_radius_mm", info.state.stop_radius_mm},
          {"focal_length_mm", f.focal_length_mm},
          {"focal_length_x_mm", f.focal_length_x_mm},
          {"back_focal_distance_mm", f.back_focal_distance_mm},
          {"back_focal_distance_x_mm", f.back_focal_distance_x_mm},
          {"front_focal_distance_mm", f.front_focal_distance_mm},
          {"entrance_pupil_position_mm", f.entrance_pupil_position_mm},
          {"entrance_pupil_diameter_mm", f.entrance_pupil_diameter_mm},
          {"exit_pupil_position_mm", f.exit_pupil_position_mm},
          {"exit_pupil_diameter_mm", f.exit_pupil_diameter_mm},
          {"f_number", f.f_number},
          {"half_field_deg", f.half_field_rad / params::kDegree_rad},
          {"seidel", seidel_json(info.seidel)},
          {"sensor_position_mm", f.sensor_position_mm},
          {"sensor_width_mm", info.state.sensor_width_mm},
          {"sensor_height_mm", info.state.sensor_height_mm},
          {"zoom", zoom},
          {"warnings", info.state.warnings}};
}

}  // namespace contrejour::cli
