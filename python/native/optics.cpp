// SPDX-License-Identifier: Apache-2.0
// Glasses, coatings, spectra, and sections of lenses.
#include <optional>
#include <string>
#include <utility>

#include "contrejour/expert/coated_glass.h"
#include "contrejour/expert/film_design.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/glass_text.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/spectrum_file.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

using NumberArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::span<const double> numbers_of(const NumberArray& array) {
  if (array.ndim() != 1) throw py::value_error("give an array of one dimension");
  return {array.data(), static_cast<std::size_t>(array.size())};
}

NumberArray array_of_numbers(const std::vector<double>& numbers) {
  return NumberArray(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

template <class Value>
NumberArray by_wavelength(const NumberArray& lambda_nm, const Value& value) {
  std::vector<double> values;
  for (const double nm : numbers_of(lambda_nm)) {
    if (!(nm >= 1.0 && nm <= 1e6)) throw py::value_error("a wavelength is out of range; give nm, as 550");
    values.push_back(value(nm));
  }
  return array_of_numbers(values);
}

py::dict dict_of(const Glass& glass) {
  const GlassFigures figures = glass_figures(glass);
  py::dict fields;
  fields["name"] = glass.name;
  fields["index_d"] = figures.n_d;
  fields["abbe_d"] = figures.v_d;
  fields["abbe_e"] = figures.v_e;
  fields["p_gf"] = figures.p_gf;
  fields["d_pgf"] = figures.d_pgf;
  const auto range = wavelength_range_nm(glass);
  fields["range_nm"] = range ? py::object(py::make_tuple(range->first_nm, range->last_nm)) : py::none();
  return fields;
}

py::list bundled_glass_names() {
  py::list names;
  const GlassCatalogue& glasses = bundled_glasses();
  for (std::size_t k = 0; k < glasses.size(); ++k) {
    const GlassSummary summary = glasses.summary(k);
    names.append(summary.maker + " " + summary.name);
  }
  return names;
}

py::list closest_glasses(double index_d, double abbe_d, std::size_t count) {
  py::list names;
  for (const CloseGlass& close : bundled_glasses().closest(index_d, abbe_d, count))
    names.append(close.glass.maker + " " + close.glass.name);
  return names;
}

py::list films_of(const Coating& coating) {
  py::list films;
  const auto* stack = std::get_if<FilmStack>(&coating.films);
  if (stack == nullptr) return films;
  for (const FilmLayer& layer : stack->layers)
    films.append(py::make_tuple(layer.material.name, index_at(layer.material, 550.0), layer.thickness_nm));
  return films;
}

Coating refined_coating(const Coating& start, const Glass& glass, const NumberArray& lambda_nm,
                        const NumberArray& target, const std::optional<NumberArray>& weight) {
  const auto weights = weight ? numbers_of(*weight) : std::span<const double>();
  const auto wavelengths = numbers_of(lambda_nm), targets = numbers_of(target);
  const py::gil_scoped_release unlocked;
  return {"", value_of(refined_to_targets(start, glass, wavelengths, targets, weights))};
}

SectionRequest section_request(const LensState& lens, double lambda_nm, const std::vector<std::vector<int>>& ghosts,
                               std::optional<double> light_rad) {
  SectionRequest request;
  request.lambda_nm = lambda_nm;
  for (const std::vector<int>& surfaces : ghosts) {
    const auto ghost = ghost_of(surfaces);
    if (!ghost || !has_ghost(lens, *ghost)) throw py::value_error("the lens has no such ghost");
    request.ghosts.push_back(*ghost);
  }
  request.ghost_light_rad = light_rad;
  return request;
}

py::dict line_of(const char* kind, std::size_t index, bool is_blocked, const std::vector<Vec2>& points) {
  NumberArray array({static_cast<py::ssize_t>(points.size()), py::ssize_t{2}});
  for (std::size_t k = 0; k < points.size(); ++k) {
    array.mutable_data()[2 * k] = points[k].x;
    array.mutable_data()[2 * k + 1] = points[k].y;
  }
  py::dict line;
  line["kind"] = kind;
  line["index"] = index;
  line["blocked"] = is_blocked;
  line["points_mm"] = std::move(array);
  return line;
}

const char* kind_name(SectionRayKind kind) {
  switch (kind) {
    case SectionRayKind::Axis: return "axis ray";
    case SectionRayKind::Field: return "field ray";
    case SectionRayKind::Ghost: return "ghost ray";
  }
  return "ghost ray";
}

py::list lines_of(const LensSection& section) {
  py::list lines;
  for (const SectionElement& element : section.elements)
    lines.append(line_of("element", element.front + 1, false, polyline(element.outline)));
  for (const SectionSurface& surface : section.surfaces)
    lines.append(line_of("surface", surface.surface + 1, false, polyline(surface.curve)));
  for (std::size_t k = 0; k < section.obscurations.size(); ++k)
    lines.append(line_of("obscuration", k, false, polyline(section.obscurations[k])));
  const auto stop = static_cast<std::size_t>(section.lens.stop_index) + 1;
  for (const double side : {1.0, -1.0})
    lines.append(line_of(
        "stop", stop, false,
        {{section.stop.z_mm, side * section.stop.opening_mm}, {section.stop.z_mm, side * section.stop.outer_mm}}));
  const double half = section.sensor.half_height_mm;
  lines.append(line_of("sensor", 0, false, {{section.sensor.z_mm, half}, {section.sensor.z_mm, -half}}));
  for (const SectionRay& ray : section.rays)
    lines.append(line_of(kind_name(ray.kind), ray.ghost, ray.blocked, ray.points_mm));
  return lines;
}

void add_glass_class(py::module_& module) {
  py::class_<Glass>(module, "Glass")
      .def("figures", [](const Glass& glass) { return dict_of(glass); })
      .def(
          "index",
          [](const Glass& glass, const NumberArray& lambda_nm) {
            return by_wavelength(lambda_nm, [&](double nm) { return refractive_index(glass, nm); });
          },
          py::arg("lambda_nm"))
      .def(
          "transmittance",
          [](const Glass& glass, double path_mm, const NumberArray& lambda_nm) {
            return by_wavelength(lambda_nm, [&](double nm) { return internal_transmittance(glass, nm, path_mm); });
          },
          py::arg("path_mm"), py::arg("lambda_nm"));
  module.def("bundled_glasses", bundled_glass_names);
  module.def("closest_glasses", closest_glasses, py::arg("index_d"), py::arg("abbe_d"), py::arg("count"));
  module.def(
      "find_glass", [](const std::string& text) { return value_of(params::parse_glass(text)); }, py::arg("text"));
}

void add_coating_class(py::module_& module) {
  py::class_<Coating>(module, "Coating")
      .def("description", [](const Coating& coating) { return describe(coating); })
      .def("films", films_of)
      .def(
          "on_glass",
          [](const Coating& coating, const Glass& glass) { return Coating{"", value_of(films_on(coating, glass))}; },
          py::arg("glass"))
      .def("refined", refined_coating, py::arg("glass"), py::arg("lambda_nm"), py::arg("target"), py::arg("weight"))
      .def(
          "reflectance",
          [](const Coating& coating, const Glass& glass, const NumberArray& lambda_nm, const NumberArray& angle_rad) {
            return array_of_numbers(
                value_of(coated_reflectances(coating, glass, numbers_of(lambda_nm), numbers_of(angle_rad))));
          },
          py::arg("glass"), py::arg("lambda_nm"), py::arg("angle_rad"))
      .def(
          "transmittance",
          [](const Coating& coating, const Glass& glass, const NumberArray& lambda_nm, const NumberArray& angle_rad) {
            return array_of_numbers(
                value_of(coated_transmittances(coating, glass, numbers_of(lambda_nm), numbers_of(angle_rad))));
          },
          py::arg("glass"), py::arg("lambda_nm"), py::arg("angle_rad"));
  module.def(
      "read_coating", [](const std::string& text) { return value_of(params::parse_coating(text)); }, py::arg("text"));
  module.def("coating_designs", coating_design_names);
}

void add_spectra(py::module_& module) {
  module.def("bundled_spectra", [] {
    py::dict spectra;
    for (const BundledSpectrum& spectrum : bundled_spectra()) spectra[py::str(spectrum.name)] = spectrum.what;
    return spectra;
  });
  module.def(
      "spectral_power",
      [](const std::string& text, const NumberArray& lambda_nm) {
        const Spectrum spectrum = value_of(find_spectrum(text));
        return by_wavelength(lambda_nm, [&](double nm) { return spectral_power(spectrum, nm); });
      },
      py::arg("spectrum"), py::arg("lambda_nm"));
  module.def(
      "spectrum_rgb",
      [](const std::string& text, bool is_acescg) {
        const Rgb rgb = rgb_of(value_of(find_spectrum(text)), is_acescg ? ColourSpace::AcesCg : ColourSpace::Rec709);
        return py::make_tuple(rgb[0], rgb[1], rgb[2]);
      },
      py::arg("spectrum"), py::arg("acescg"));
}

}  // namespace

void add_optics(py::module_& module) {
  add_glass_class(module);
  add_coating_class(module);
  add_spectra(module);
  module.def(
      "section_svg",
      [](const LensState& lens, double lambda_nm, const std::vector<std::vector<int>>& ghosts,
         std::optional<double> light_rad) {
        return section_svg(lens_section(lens, section_request(lens, lambda_nm, ghosts, light_rad)));
      },
      py::arg("lens"), py::arg("lambda_nm"), py::arg("ghosts"), py::arg("light_rad"));
  module.def(
      "section_lines",
      [](const LensState& lens, double lambda_nm, const std::vector<std::vector<int>>& ghosts,
         std::optional<double> light_rad) {
        return lines_of(lens_section(lens, section_request(lens, lambda_nm, ghosts, light_rad)));
      },
      py::arg("lens"), py::arg("lambda_nm"), py::arg("ghosts"), py::arg("light_rad"));
}

}  // namespace contrejour::python
