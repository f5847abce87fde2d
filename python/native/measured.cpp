// SPDX-License-Identifier: Apache-2.0
// Flares measured from photographs.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "contrejour/expert/flare_source.h"
#include "native/errors.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

py::object exposure_of(const MeasuredFlare& flare) {
  if (!flare.exposure) return py::none();
  return py::make_tuple(flare.exposure->f_number, flare.exposure->iso, flare.exposure->time_s);
}

std::vector<std::string> ghost_names(const MeasuredFlare& flare) {
  std::vector<std::string> names;
  for (const MeasuredGhost& ghost : flare.ghosts) names.push_back(ghost.name);
  return names;
}

}  // namespace

void add_measured(py::module_& module) {
  py::class_<MeasuredFlare, std::shared_ptr<MeasuredFlare>>(module, "MeasuredFlare")
      .def_readonly("name", &MeasuredFlare::name)
      .def_readonly("source", &MeasuredFlare::source)
      .def_readonly("s_max", &MeasuredFlare::s_max)
      .def_property_readonly("exposure", exposure_of)
      .def_property_readonly("ghosts", ghost_names)
      .def("geometry", [](const MeasuredFlare& flare) { return std::make_shared<LensState>(ideal_lens_of(flare)); })
      .def("toml", write_flare);
  module.def("is_measured_flare", [](const std::string& name) { return is_measured_flare(name); }, py::arg("name"));
  module.def(
      "read_flare",
      [](const std::string& file) {
        return std::make_shared<MeasuredFlare>(value_of(read_flare(std::filesystem::path(file))));
      },
      py::arg("file"));
}

}  // namespace contrejour::python
