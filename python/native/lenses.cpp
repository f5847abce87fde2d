// SPDX-License-Identifier: Apache-2.0
// Lenses as published, configured lenses, and their figures.
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/glass_text.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/spectrum_file.h"
#include "contrejour/expert/write_lens.h"
#include "native/errors.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

double radius_of(double curvature_per_mm) {
  return curvature_per_mm == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / curvature_per_mm;
}

py::dict dict_of(const Surface& s) {
  const GlassFigures glass = glass_figures(s.glass_after);
  py::dict fields;
  fields["kind"] = s.kind == SurfaceKind::Stop ? "stop" : "refracting";
  fields["radius_mm"] = radius_of(s.curvature_per_mm);
  fields["thickness_mm"] = s.thickness_mm;
  fields["semi_diameter_mm"] = s.semi_diameter_mm;
  fields["glass"] = is_air(s.glass_after) ? "air" : s.glass_after.name;
  fields["index_d"] = glass.n_d;
  fields["abbe_d"] = glass.v_d;
  fields["coating"] = describe(s.coating);
  fields["is_sphere"] = s.shape.is_sphere() && s.pose == SurfacePose{};
  return fields;
}

py::list surfaces_of(const Prescription& lens) {
  py::list all;
  for (const Surface& s : lens.surfaces) all.append(dict_of(s));
  return all;
}

std::vector<double> zoom_of(const Prescription& lens) {
  std::vector<double> focal_lengths_mm;
  for (const ZoomPosition& position : lens.zoom) focal_lengths_mm.push_back(position.focal_length_mm);
  return focal_lengths_mm;
}

py::tuple tuple_of_written(Result<WrittenLens> written) {
  WrittenLens lens = value_of(std::move(written));
  return py::make_tuple(std::move(lens.text), std::move(lens.losses));
}

// The text, and what the format cannot hold.
py::tuple written(const Prescription& lens, const std::string& format) {
  if (format == "toml") return py::make_tuple(write_lens_toml(lens), std::vector<std::string>());
  if (format == "zmx") return tuple_of_written(write_lens_zmx(lens));
  if (format == "seq") return tuple_of_written(write_lens_seq(lens));
  throw py::value_error("\"" + format + "\" is not a format; give toml, zmx or seq");
}

py::tuple written_ghost(const LensState& lens, const std::vector<int>& surfaces, const std::string& format) {
  const auto ghost = ghost_of(surfaces);
  if (!ghost) throw py::value_error("give the surfaces of a ghost, as (2, 5)");
  if (format == "zmx") return tuple_of_written(write_ghost_zmx(lens, *ghost));
  if (format == "seq") return tuple_of_written(write_ghost_seq(lens, *ghost));
  throw py::value_error("\"" + format + "\" is not a format for a ghost; give zmx or seq");
}

// A copy in which one surface (from 0) has these values, where they are given.
Prescription with_surface(const Prescription& lens, std::size_t index, std::optional<double> radius_mm,
                          std::optional<double> thickness_mm, std::optional<double> semi_diameter_mm,
                          const std::optional<std::string>& glass, const std::optional<std::string>& coating) {
  if (index >= lens.surfaces.size()) throw py::index_error("the lens has no such surface");
  Prescription changed = lens;
  Surface& surface = changed.surfaces[index];
  if (radius_mm) surface.curvature_per_mm = std::isinf(*radius_mm) ? 0.0 : 1.0 / *radius_mm;
  if (thickness_mm) surface.thickness_mm = *thickness_mm;
  if (semi_diameter_mm) surface.semi_diameter_mm = *semi_diameter_mm;
  if (glass) surface.glass_after = value_of(params::parse_glass(*glass));
  if (coating) surface.coating = value_of(params::parse_coating(*coating));
  value_of(validate(changed));
  return changed;
}

py::dict figures_of(const LensState& lens, double lambda_nm) {
  const FirstOrder f = first_order(lens, lambda_nm);
  py::dict fields;
  fields["focal_length_mm"] = f.focal_length_mm;
  fields["back_focal_distance_mm"] = f.back_focal_distance_mm;
  fields["front_focal_distance_mm"] = f.front_focal_distance_mm;
  fields["entrance_pupil_position_mm"] = f.entrance_pupil_position_mm;
  fields["entrance_pupil_diameter_mm"] = f.entrance_pupil_diameter_mm;
  fields["exit_pupil_position_mm"] = f.exit_pupil_position_mm;
  fields["exit_pupil_diameter_mm"] = f.exit_pupil_diameter_mm;
  fields["f_number"] = f.f_number;
  fields["sensor_position_mm"] = f.sensor_position_mm;
  fields["half_field_rad"] = f.half_field_rad;
  fields["focal_length_x_mm"] = f.focal_length_x_mm;
  fields["back_focal_distance_x_mm"] = f.back_focal_distance_x_mm;
  return fields;
}

py::list seidel_of(const LensState& lens, double lambda_nm, double half_field_rad) {
  py::list all;
  SeidelRequest request;
  request.lambda_nm = lambda_nm;
  request.half_field_rad = half_field_rad;
  for (const SeidelSums& s : seidel_by_surface(lens, request))
    all.append(
        py::make_tuple(s.spherical, s.coma, s.astigmatism, s.petzval, s.distortion, s.axial_colour, s.lateral_colour));
  return all;
}

std::vector<std::string> lens_names() {
  std::vector<std::string> names;
  for (const BundledLens& lens : bundled_lenses()) names.emplace_back(lens.name);
  return names;
}

void add_prescription(py::module_& module) {
  py::class_<Prescription>(module, "Prescription")
      .def_readonly("name", &Prescription::name)
      .def_readonly("source", &Prescription::source)
      .def_readonly("f_number", &Prescription::f_number)
      .def_readonly("sensor_width_mm", &Prescription::sensor_width_mm)
      .def_readonly("sensor_height_mm", &Prescription::sensor_height_mm)
      .def_readonly("warnings", &Prescription::warnings)
      .def_property_readonly("zoom_mm", zoom_of)
      .def("surfaces", surfaces_of)
      .def("with_surface", with_surface, py::arg("index"), py::arg("radius_mm"), py::arg("thickness_mm"),
           py::arg("semi_diameter_mm"), py::arg("glass"), py::arg("coating"))
      .def("written", written, py::arg("format"));
  module.def("bundled_lenses", lens_names);
  module.def(
      "find_lens", [](const std::string& name_or_file) { return value_of(find_lens(name_or_file)); },
      py::arg("name_or_file"));
  module.def(
      "read_lens_toml",
      [](const std::string& text, const std::string& file) { return value_of(read_lens_toml(text, file)); },
      py::arg("text"), py::arg("file"));
}

void add_lens_state(py::module_& module) {
  // Readers of a state need not change it, which pybind11's holder cannot say.
  py::class_<LensState, std::shared_ptr<LensState>>(module, "LensState")
      .def_readonly("name", &LensState::name)
      .def_readonly("focal_length_mm", &LensState::focal_length_mm)
      .def_readonly("f_number", &LensState::f_number)
      .def_readonly("object_distance_mm", &LensState::object_distance_mm)
      .def_readonly("stop_radius_mm", &LensState::stop_radius_mm)
      .def_readonly("sensor_width_mm", &LensState::sensor_width_mm)
      .def_readonly("sensor_height_mm", &LensState::sensor_height_mm)
      .def_readonly("sensor_z_mm", &LensState::sensor_z_mm)
      .def_readonly("design_wavelength_nm", &LensState::design_wavelength_nm)
      .def_readonly("warnings", &LensState::warnings)
      .def("first_order", figures_of, py::arg("lambda_nm"))
      .def("seidel", seidel_of, py::arg("lambda_nm"), py::arg("half_field_rad"))
      .def("written_ghost", written_ghost, py::arg("ghost"), py::arg("format"));
  module.def(
      "configure_lens",
      [](const Prescription& lens, const params::Values& values) {
        return std::make_shared<LensState>(value_of(params::lens_of(lens, values)));
      },
      py::arg("lens"), py::arg("values"));
}

}  // namespace

Light light_of(const LightFields& fields) {
  const auto& [direction, value, spectrum, distance_mm, radius_rad] = fields;
  Light light;
  light.direction = {std::get<0>(direction), std::get<1>(direction), std::get<2>(direction)};
  if (!(length(light.direction) > 0.0)) throw py::value_error("a light's direction has no length");
  light.direction = normalized(light.direction);
  light.value = {std::get<0>(value), std::get<1>(value), std::get<2>(value)};
  light.spectrum = value_of(find_spectrum(spectrum));
  light.distance_mm = distance_mm;
  light.radius_rad = radius_rad;
  return light;
}

std::vector<Light> lights_of(const std::vector<LightFields>& fields) {
  std::vector<Light> lights;
  for (const LightFields& one : fields) lights.push_back(light_of(one));
  return lights;
}

std::optional<Ghost> ghost_of(const std::vector<int>& surfaces) {
  if (surfaces.empty()) return std::nullopt;
  if (surfaces.size() != 2 && surfaces.size() != 4) throw py::value_error("a ghost has two surfaces, or four");
  Ghost ghost;
  ghost.i = surfaces[0];
  ghost.j = surfaces[1];
  if (surfaces.size() == 4) {
    ghost.k = surfaces[2];
    ghost.l = surfaces[3];
  }
  return ghost;
}

void add_lenses(py::module_& module) {
  add_prescription(module);
  add_lens_state(module);
}

}  // namespace contrejour::python
