// SPDX-License-Identifier: Apache-2.0
// The direct image by polynomials: fits, files, camera rays and the way back.
#include <array>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "contrejour/expert/direct_polynomials.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

using Rows = py::array_t<double, py::array::c_style | py::array::forcecast>;

void demand_rows(const Rows& rows, py::ssize_t count, py::ssize_t columns, const char* name) {
  if (rows.ndim() != 2 || rows.shape(0) != count || rows.shape(1) != columns)
    throw py::value_error(std::string(name) + " must have shape (n, " + std::to_string(columns) + ")");
}

std::shared_ptr<DirectPolynomials> fit_direct(const LensState& lens, const params::Values& values, int max_order,
                                              const py::object& progress, CancelFlag* cancel) {
  LongCall call(values.integer("threads"), {progress, cancel});
  return std::make_shared<DirectPolynomials>(call.run(
      [&](const Context& context) { return fit_direct_polynomials(lens, {.max_order = max_order}, context); }));
}

std::shared_ptr<DirectPolynomials> read_direct(const py::bytes& content, const std::string& file) {
  return std::make_shared<DirectPolynomials>(value_of(read_direct_polynomials(std::string(content), file)));
}

// Arrays: origin (n, 3), direction (n, 3), relative height, transmittance, weight (n,); NaN where there is no ray.
py::tuple rays_of(const DirectPolynomials& fit, const Rows& sensor_mm, const Rows& stop, double lambda_nm) {
  const py::ssize_t count = sensor_mm.ndim() == 2 ? sensor_mm.shape(0) : 0;
  demand_rows(sensor_mm, count, 2, "sensor_mm");
  demand_rows(stop, count, 2, "stop");
  const auto from = sensor_mm.unchecked<2>(), through = stop.unchecked<2>();
  py::array_t<double> origin({count, py::ssize_t{3}}), direction({count, py::ssize_t{3}});
  std::array<py::array_t<double>, 3> scalars{py::array_t<double>(count), py::array_t<double>(count),
                                             py::array_t<double>(count)};
  auto to_origin = origin.mutable_unchecked<2>(), to_direction = direction.mutable_unchecked<2>();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (py::ssize_t k = 0; k < count; ++k) {
    const auto found = direct_ray(fit, {from(k, 0), from(k, 1)}, {through(k, 0), through(k, 1)}, lambda_nm);
    const DirectRay ray = found.value_or(DirectRay{{kNone, kNone, kNone}, {kNone, kNone, kNone}, kNone, kNone, kNone});
    to_origin(k, 0) = ray.origin_mm.x, to_origin(k, 1) = ray.origin_mm.y, to_origin(k, 2) = ray.origin_mm.z;
    to_direction(k, 0) = ray.direction.x, to_direction(k, 1) = ray.direction.y, to_direction(k, 2) = ray.direction.z;
    scalars[0].mutable_at(k) = ray.relative_height;
    scalars[1].mutable_at(k) = ray.transmittance;
    scalars[2].mutable_at(k) = ray.weight;
  }
  return py::make_tuple(origin, direction, scalars[0], scalars[1], scalars[2]);
}

Rows sensor_points(const DirectPolynomials& fit, const Rows& points_mm, bool distant, const Rows& stop,
                   double lambda_nm) {
  const py::ssize_t count = points_mm.ndim() == 2 ? points_mm.shape(0) : 0;
  demand_rows(points_mm, count, 3, "points_mm");
  demand_rows(stop, count, 2, "stop");
  const auto at = points_mm.unchecked<2>(), through = stop.unchecked<2>();
  Rows found({count, py::ssize_t{2}});
  auto to = found.mutable_unchecked<2>();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (py::ssize_t k = 0; k < count; ++k) {
    const Vec2 point =
        direct_sensor_point(fit, {{at(k, 0), at(k, 1), at(k, 2)}, distant}, {through(k, 0), through(k, 1)}, lambda_nm)
            .value_or(Vec2{kNone, kNone});
    to(k, 0) = point.x, to(k, 1) = point.y;
  }
  return found;
}

py::dict accuracy_of(const DirectPolynomials& fit) {
  const DirectAccuracy& a = fit.accuracy;
  py::dict out;
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, double>>{{"sensor_p50_px", a.sensor_p50_px},
                                                             {"sensor_p95_px", a.sensor_p95_px},
                                                             {"sensor_max_px", a.sensor_max_px},
                                                             {"stop_p95", a.stop_p95},
                                                             {"rim_p95", a.rim_p95},
                                                             {"transmittance_p95", a.transmittance_p95},
                                                             {"let_through", a.let_through},
                                                             {"blocked", a.blocked}})
    out[name] = value;
  out["rays"] = a.rays;
  return out;
}

std::string source_of(const DirectPolynomials& fit, const std::string& language, const std::string& prefix) {
  constexpr std::array<const char*, 4> kLanguages{"c", "glsl", "hlsl", "python"};  // in the order of the enumeration
  for (std::size_t k = 0; k < kLanguages.size(); ++k)
    if (language == kLanguages[k])
      return value_of(export_direct_polynomials(fit, static_cast<PolynomialLanguage>(k), prefix));
  throw py::value_error("the language is c, glsl, hlsl or python");
}

}  // namespace

void add_direct_polynomials(py::module_& module) {
  py::class_<DirectPolynomials, std::shared_ptr<DirectPolynomials>>(module, "DirectPolynomials")
      .def_readonly("lens", &DirectPolynomials::lens)
      .def_readonly("focal_length_mm", &DirectPolynomials::focal_length_mm)
      .def_readonly("front_z_mm", &DirectPolynomials::front_z_mm)
      .def_readonly("sensor_z_mm", &DirectPolynomials::sensor_z_mm)
      .def_readonly("stop_radius_mm", &DirectPolynomials::stop_radius_mm)
      .def_readonly("max_height_mm", &DirectPolynomials::max_height_mm)
      .def_property_readonly("order", [](const DirectPolynomials& fit) { return order_of(fit); })
      .def("accuracy", accuracy_of)
      .def("written", [](const DirectPolynomials& fit) { return py::bytes(write_direct_polynomials(fit)); })
      .def(
          "at_wavelength",
          [](const DirectPolynomials& fit, double lambda_nm) {
            return std::make_shared<DirectPolynomials>(at_wavelength(fit, lambda_nm));
          },
          py::arg("lambda_nm"))
      .def("source", source_of, py::arg("language"), py::arg("prefix"))
      .def("rays", rays_of, py::arg("sensor_mm"), py::arg("stop"), py::arg("lambda_nm"))
      .def("sensor_points", sensor_points, py::arg("points_mm"), py::arg("distant"), py::arg("stop"),
           py::arg("lambda_nm"));
  module.def("fit_direct_polynomials", fit_direct, py::arg("lens"), py::arg("values"), py::arg("max_order"),
             py::arg("progress"), py::arg("cancel"));
  module.def("read_direct_polynomials", read_direct, py::arg("content"), py::arg("file"));
}

}  // namespace contrejour::python
