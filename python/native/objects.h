// SPDX-License-Identifier: Apache-2.0
// Python's arguments in the library's types.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour::python {

namespace py = pybind11;

// The fields of contrejour.Light: direction, value, spectrum, distance_mm, radius_rad.
using LightFields =
    std::tuple<std::tuple<double, double, double>, std::tuple<double, double, double>, std::string, double, double>;

// A window of a picture: x, y, width, height.
using WindowFields = std::tuple<int, int, int, int>;
[[nodiscard]] inline PixelWindow window_of_fields(const WindowFields& fields) {
  const auto [x, y, width, height] = fields;
  return {x, y, width, height};
}

// Errors: a spectrum that there is not.
[[nodiscard]] Light light_of(const LightFields& fields);
[[nodiscard]] std::vector<Light> lights_of(const std::vector<LightFields>& fields);

// Empty for the direct image, else (i, j) or (i, j, k, l). Errors: another number of surfaces.
[[nodiscard]] std::optional<Ghost> ghost_of(const std::vector<int>& surfaces);

[[nodiscard]] inline py::tuple tuple_of(Vec2 v) { return py::make_tuple(v.x, v.y); }
[[nodiscard]] inline py::tuple tuple_of(Vec3 v) { return py::make_tuple(v.x, v.y, v.z); }

void add_settings(py::module_& module);
void add_lenses(py::module_& module);
void add_optics(py::module_& module);
void add_measured(py::module_& module);
void add_rays(py::module_& module);
void add_rendering(py::module_& module);
void add_polynomials(py::module_& module);
void add_direct_polynomials(py::module_& module);
void add_pictures(py::module_& module);

}  // namespace contrejour::python
