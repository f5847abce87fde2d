// SPDX-License-Identifier: Apache-2.0
// The table of parameters, settings and presets.
#include <string>
#include <utility>

#include "contrejour/expert/parameter.h"
#include "contrejour/preset.h"
#include "native/errors.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

const char* kind_name(params::Kind kind) {
  switch (kind) {
    case params::Kind::Real: return "real";
    case params::Kind::Integer: return "integer";
    case params::Kind::Choice: return "choice";
    case params::Kind::Switch: return "switch";
    case params::Kind::Text: return "text";
  }
  return "text";
}

py::dict dict_of(const params::Parameter& p) {
  py::dict fields;
  fields["name"] = p.name;
  fields["group"] = p.group;
  fields["kind"] = kind_name(p.kind);
  fields["unit"] = p.unit;
  fields["minimum"] = p.minimum;
  fields["maximum"] = p.maximum;
  fields["default"] = p.fallback;
  fields["help"] = p.help;
  fields["choices"] = py::tuple(py::cast(p.choices));
  fields["repeats"] = p.repeats;
  fields["scene"] = p.scene;
  return fields;
}

py::list parameters() {
  py::list all;
  for (const params::Parameter& p : params::all_parameters()) all.append(dict_of(p));
  return all;
}

void set_value(params::Values& values, const std::string& name, std::string text) {
  auto set = values.set(name, std::move(text));
  if (!set) set.error().message = name + ": " + set.error().message;
  value_of(std::move(set));
}

// The values given to a parameter, or its default.
std::vector<std::string> texts_of(const params::Values& values, const std::string& name) {
  if (params::parameter(name).repeats) return values.list(name);
  const auto text = values.text(name);
  return text ? std::vector<std::string>{*text} : std::vector<std::string>{};
}

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const params::BundledPreset& preset : params::bundled_presets()) names.emplace_back(preset.name);
  return names;
}

}  // namespace

void add_settings(py::module_& module) {
  module.def("parameters", parameters);
  module.def("bundled_presets", preset_names);
  py::class_<params::Values>(module, "Values")
      .def(py::init<>())
      .def("set", set_value, py::arg("name"), py::arg("text"))
      .def("over", &params::Values::over, py::arg("base"))
      .def(
          "given", [](const params::Values& values, const std::string& name) { return values.given(name); },
          py::arg("name"))
      .def("texts", texts_of, py::arg("name"));
  module.def(
      "find_preset",
      [](const std::string& name_or_file) {
        auto preset = value_of(params::find_preset(name_or_file));
        return py::make_tuple(preset.name, preset.description, preset.lens, std::move(preset.values));
      },
      py::arg("name_or_file"));
}

}  // namespace contrejour::python
