// SPDX-License-Identifier: Apache-2.0
// contrejour lens info: surfaces and first-order properties of a lens.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/section.h"
#include "cli/text_table.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLensInfoExamples =
    "Indices and figures are for --wavelength; n_d is always for the d line. A plane has no radius. The last "
    "surface's\n"
    "thickness leads to the sensor. Entrance pupil and front focal point are measured from surface 1, back focus and\n"
    "sensor from the last surface, the exit pupil from the sensor; positive towards the image.\n\n"
    "Examples:\n"
    "  contrejour lens info heliar\n"
    "  contrejour lens info canon-70-200 --focal 135 -f 4 --focus 3m --json";

struct InfoOptions {
  std::string lens;
  bool json = false;
  bool seidel = false;
  params::Values values;
};

struct Info {
  Prescription lens;
  LensState state;
  FirstOrder figures;
  double lambda_nm = 0;
  std::vector<SeidelSums> seidel;  // by surface
};

std::string glass_name(const Glass& glass) {
  if (is_air(glass)) return "air";
  return glass.name.empty() ? fmt::format("n_d {:.5f}", refractive_index(glass, kLineD_nm)) : glass.name;
}

double thickness_mm(const LensState& lens, std::size_t k) {
  const double next_mm = k + 1 < lens.surfaces.size() ? lens.surfaces[k + 1].z_mm : lens.sensor_z_mm;
  return next_mm - lens.surfaces[k].z_mm;
}

std::string shape_name(double curvature_per_mm, const SurfaceShape& shape) {
  const bool has_powers = std::any_of(shape.powers.begin(), shape.powers.end(), [](double a) { return a != 0.0; });
  const bool flat_one_way = (curvature_per_mm == 0.0) != (shape.curvature_x_per_mm == 0.0);
  switch (shape.kind) {
    case ShapeKind::Revolution: return shape.is_sphere() ? "" : has_powers ? "asphere" : "conic";
    case ShapeKind::Toroid: return flat_one_way && !has_powers ? "cylinder" : "toroid";
    case ShapeKind::Biconic: return "biconic";
  }
  return "";
}

Json shape_json(double curvature_per_mm, const SurfaceShape& shape) {
  Json out = {{"kind", shape_name(curvature_per_mm, shape)}, {"conic", shape.conic}, {"powers", Json::object()}};
  for (std::size_t k = 0; k < shape.powers.size(); ++k) {
    if (shape.powers[k] != 0.0) out["powers"][fmt::format("{}", k + 1)] = shape.powers[k];
  }
  if (shape.has_axial_symmetry()) return out;
  out["curvature_x_per_mm"] = shape.curvature_x_per_mm;
  out["conic_x"] = shape.conic_x;
  out["turn_deg"] = shape.turn_rad / params::kDegree_rad;
  return out;
}

// A ClearAperture or an Obscuration.
template <class Part>
Json outline_json(const char* kind, const Part& part) {
  return {{"kind", kind},
          {"half_mm", {part.half_mm.x, part.half_mm.y}},
          {"centre_mm", {part.centre_mm.x, part.centre_mm.y}},
          {"turn_deg", part.turn_rad / params::kDegree_rad}};
}

const char* kind_name(ApertureKind kind) { return kind == ApertureKind::Ellipse ? "ellipse" : "rectangle"; }

// A surface's shape; if its radius in the x-z section differs, that as well.
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
  if (!s.is_centred()) add("askew");
  return text;
}

const char* kind_name(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::Refracting: return "refracting";
    case SurfaceKind::Stop: return "stop";
    case SurfaceKind::Sensor: return "sensor";
  }
  return "";
}

Json surfaces_json(const Info& info) {
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

Json info_json(const Info& info) {
  const FirstOrder& f = info.figures;
  Json zoom = Json::array();
  for (const ZoomPosition& position : info.lens.zoom) zoom.push_back(position.focal_length_mm);
  return {{"name", info.lens.name},
          {"source", info.lens.source},
          {"wavelength_nm", info.lambda_nm},
          {"surfaces", surfaces_json(info)},
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

std::string surfaces_text(const Info& info) {
  const auto has_news = [](const SurfaceState& s) {
    return !s.shape.is_sphere() || !s.is_centred() || s.aperture.kind != ApertureKind::Disc || s.obscuration.any();
  };
  const bool all_plain = std::none_of(info.state.surfaces.begin(), info.state.surfaces.end(), has_news);
  std::vector<std::string> headings{"surface",       "radius mm", "thickness mm", "semi-diameter mm",
                                    "<glass behind", "n",         "<coating"};
  if (!all_plain) headings.emplace_back("<shape");
  TextTable table(headings);
  for (std::size_t k = 0; k < info.state.surfaces.size(); ++k) {
    const SurfaceState& s = info.state.surfaces[k];
    const bool stop = s.kind == SurfaceKind::Stop;
    const double semi_mm = stop ? info.state.stop_radius_mm : s.semi_diameter_mm;
    const std::string radius = s.curvature_per_mm == 0.0 ? "plane" : fmt::format("{:.4f}", 1.0 / s.curvature_per_mm);
    std::vector<std::string> row{fmt::format("{}", k + 1),
                                 s.kind == SurfaceKind::Refracting ? radius : kind_name(s.kind),
                                 fmt::format("{:.4f}", thickness_mm(info.state, k)),
                                 has_real_rim(info.state, s) ? fmt::format("{:.3f}", semi_mm) : "",
                                 glass_name(s.after),
                                 fmt::format("{:.6f}", refractive_index(s.after, info.lambda_nm)),
                                 stop ? "" : describe(s.coating)};
    if (!all_plain) row.push_back(shape_text(s));
    table.add(std::move(row));
  }
  return table.text();
}

std::string figures_text(const Info& info) {
  const FirstOrder& f = info.figures;
  TextTable table({"<", "", "<"});
  const auto add = [&](const std::string& name, double value, const std::string& unit) {
    table.add({name, fmt::format("{:.4f}", value), unit});
  };
  add("focal length", f.focal_length_mm, "mm");
  const bool anamorphic = f.focal_length_x_mm != f.focal_length_mm;
  if (anamorphic) add("  in the x-z section", f.focal_length_x_mm, "mm");
  add("back focal distance", f.back_focal_distance_mm, "mm from the last surface");
  if (anamorphic) add("  in the x-z section", f.back_focal_distance_x_mm, "mm");
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

// In wavelengths, the usual unit of third-order coefficients.
std::string seidel_text(const Info& info) {
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
  return "\nSeidel's sums in waves, at the f-number and half field above, colour from F to C\n" + table.text();
}

std::string info_text(const Info& info) {
  std::string text = fmt::format("{}\n{}\n", info.lens.name, info.lens.source);
  if (!info.lens.zoom.empty()) {
    text += fmt::format("zoom from {:g} to {:g} mm, here {:.2f} mm\n", info.lens.zoom.front().focal_length_mm,
                        info.lens.zoom.back().focal_length_mm, info.state.focal_length_mm);
  }
  return text + fmt::format("\n{}\nat {:g} nm\n{}", surfaces_text(info), info.lambda_nm, figures_text(info));
}

Result<int> run_info(const InfoOptions& options) {
  auto lens = prescription_of(options.lens);
  if (!lens) return tl::unexpected(lens.error());
  auto state = params::lens_of(*lens, options.values);
  if (!state) return tl::unexpected(state.error());
  const double lambda_nm = wavelength_nm(options.values, *state);
  const FirstOrder figures = first_order(*state, lambda_nm);
  auto seidel = seidel_by_surface(*state, {.lambda_nm = lambda_nm, .half_field_rad = figures.half_field_rad});
  const Info info{std::move(*lens), std::move(*state), figures, lambda_nm, std::move(seidel)};
  if (options.json) {
    print_json(info_json(info));
  } else {
    print(info_text(info) + (options.seidel ? seidel_text(info) : ""));
    print_warnings(info.state.warnings);
  }
  return kDone;
}

}  // namespace

void add_lens_info(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = lens.add_subcommand("info", "surfaces and first-order figures");
  add_lens_argument(*command, options->lens);
  command->add_flag("--json", options->json, "as JSON");
  command->add_flag("--seidel", options->seidel, "third-order aberrations too, by surface (as JSON always)");
  add_lens_parameters(*command, options->values);
  for (const auto names : {std::span<const std::string_view>(kIris), {kGrating}, {kDirt}})
    hide_parameters(*command, names);
  hide_parameters(*command, std::array<std::string_view, 1>{"absorption"});
  add_parameters(*command, options->values, {"wavelength"});
  command->footer(kLensInfoExamples);
  command->callback([options, &action] { action = [options] { return run_info(*options); }; });
}

}  // namespace contrejour::cli
