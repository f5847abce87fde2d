// SPDX-License-Identifier: Apache-2.0
// Ghosts fitted by polynomials: fits, files, and points of them.
#include "native/polynomials.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "contrejour/expert/settings.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

using FitPointer = std::shared_ptr<AnyFit>;

FitPointer pointer_to(LensPolynomials&& fit) {
  return std::make_shared<AnyFit>(AnyFit{std::make_shared<const LensPolynomials>(std::move(fit)), nullptr});
}
FitPointer pointer_to(LensPolynomialRange&& range) {
  return std::make_shared<AnyFit>(AnyFit{nullptr, std::make_shared<const LensPolynomialRange>(std::move(range))});
}

PolynomialOptions options_of(const params::Values& values, double half_field_rad, int max_order,
                             const std::vector<std::vector<int>>& ghosts) {
  PolynomialOptions options;
  options.half_field_rad = half_field_rad;
  options.max_order = max_order;
  options.scope = params::ghost_scope(values);
  options.reflections = params::reflections(values);
  for (const std::vector<int>& surfaces : ghosts) {
    const auto ghost = ghost_of(surfaces);
    if (!ghost) throw py::value_error("give the surfaces of a ghost, as (2, 5)");
    options.ghosts.push_back(*ghost);
  }
  return options;
}

FitPointer fit_state(const LensState& lens, const params::Values& values, double half_field_rad, int max_order,
                     const std::vector<std::vector<int>>& ghosts, const py::object& progress, CancelFlag* cancel) {
  const PolynomialOptions options = options_of(values, half_field_rad, max_order, ghosts);
  LongCall call(values.integer("threads"), {progress, cancel});
  return pointer_to(call.run([&](const Context& context) { return fit_polynomials(lens, options, context); }));
}

// variable: "zoom" or "focus".
FitPointer fit_range(const Prescription& lens, const params::Values& values, const std::string& variable,
                     const std::pair<double, double>& ends_mm, double half_field_rad, int max_order,
                     const std::vector<std::vector<int>>& ghosts, const py::object& progress, CancelFlag* cancel) {
  PolynomialRangeOptions options;
  options.variable = variable == "zoom" ? PolynomialVariable::Zoom : PolynomialVariable::Focus;
  options.from_mm = ends_mm.first;
  options.to_mm = ends_mm.second;
  options.fit = options_of(values, half_field_rad, max_order, ghosts);
  const Prescription with_size = params::with_sensor(lens, values);
  const LensSettings settings = value_of(params::lens_settings(values));
  LongCall call(values.integer("threads"), {progress, cancel});
  return pointer_to(
      call.run([&](const Context& context) { return fit_polynomial_range(with_size, settings, options, context); }));
}

py::bytes bytes_of(const AnyFit& fit) {
  return fit.state ? write_polynomials(*fit.state) : write_polynomial_range(*fit.range);
}

FitPointer read_fit(const py::bytes& content, const std::string& file) {
  return std::visit([](auto&& read) { return pointer_to(std::move(read)); },
                    value_of(read_any_polynomials(std::string(content), file)));
}

FitPointer fit_at(const AnyFit& fit, const LensState& lens) {
  if (!fit.range) throw py::value_error("this is a fit of one state; at() takes states from the fit of a range");
  return pointer_to(value_of(polynomials_at(*fit.range, lens)));
}

py::tuple surfaces_of(const Ghost& ghost) {
  if (ghost.k == 0) return py::make_tuple(ghost.i, ghost.j);
  return py::make_tuple(ghost.i, ghost.j, ghost.k, ghost.l);
}

py::dict dict_of(const PolynomialZone& zone) {
  static constexpr std::array kStates{"fitted", "traced", "dark"};  // in the order of the enumeration
  py::dict fields;
  fields["state"] = kStates[static_cast<std::size_t>(zone.state)];
  fields["field"] = py::make_tuple(zone.field_low, zone.field_high);
  fields["order"] = zone.order;
  fields["position_p95_px"] = zone.accuracy.position_p95_px;
  fields["edge_p95"] = zone.accuracy.edge_p95;
  fields["transmittance_p95"] = zone.accuracy.transmittance_p95;
  fields["flux_mm2"] = zone.flux_mm2;
  return fields;
}

py::dict dict_of(const AsymmetricZone& zone) {
  PolynomialZone common;
  common.state = zone.state;
  common.order = zone.order;
  common.accuracy = zone.accuracy;
  common.flux_mm2 = zone.flux_mm2;
  py::dict fields = dict_of(common);
  fields["field"] = py::make_tuple(zone.low.x, zone.low.y, zone.high.x, zone.high.y);
  return fields;
}

// (surfaces, zones) of each ghost; of a range, the zones of all its spans at their nodes.
py::list ghosts_of(const AnyFit& fit) {
  py::list all;
  if (fit.state) {
    for (const GhostPolynomials& ghost : fit.state->ghosts) {
      py::list zones;
      for (const AsymmetricZone& zone : ghost.asymmetric) zones.append(dict_of(zone));
      if (ghost.asymmetric.empty())
        for (const PolynomialZone& zone : ghost.zones) zones.append(dict_of(zone));
      all.append(py::make_tuple(surfaces_of(ghost.ghost), zones));
    }
    return all;
  }
  for (const GhostRange& ghost : fit.range->ghosts) {
    py::list zones;
    for (const PolynomialSpan& span : ghost.spans)
      for (const std::vector<PolynomialZone>& nodes : span.zones)
        for (const PolynomialZone& zone : nodes) zones.append(dict_of(zone));
    all.append(py::make_tuple(surfaces_of(ghost.ghost), zones));
  }
  return all;
}

constexpr const char* kNotFitted = "the ghost is not fitted at this field: it is dark, or must be traced";

const GhostPolynomials& fitted_ghost(const AnyFit& fit, const std::vector<int>& surfaces) {
  if (!fit.state) throw py::value_error("this is a fit of a range; choose a state of it with at()");
  const auto ghost = ghost_of(surfaces);
  const auto& ghosts = fit.state->ghosts;
  const auto found = ghost ? std::ranges::find(ghosts, *ghost, &GhostPolynomials::ghost) : ghosts.end();
  if (found == ghosts.end()) throw py::value_error("the fit has no such ghost");
  return *found;
}

const PolynomialZone& fitted_zone(const GhostPolynomials& ghost, double field) {
  if (!ghost.asymmetric.empty())
    throw py::value_error("the ghost has no axial symmetry: give the tangents of the field, as (x, y)");
  const PolynomialZone* const zone = find_zone(ghost, field);
  if (zone == nullptr || zone->state != PolynomialZone::State::Fitted) throw py::value_error(kNotFitted);
  return *zone;
}

using PointArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Arrays: sensor (n, 2), stop (n, crossings, 2), relative height (n,), transmittance (n,). ray_at: of a point.
template <class RayAt>
py::tuple evaluated_at(const PointArray& entrance_mm, std::size_t crossing_count, const RayAt& ray_at) {
  if (entrance_mm.ndim() != 2 || entrance_mm.shape(1) != 2) throw py::value_error("entrance_mm must have shape (n, 2)");
  const py::ssize_t count = entrance_mm.shape(0), crossings = static_cast<py::ssize_t>(crossing_count);
  py::array_t<double> sensor({count, py::ssize_t{2}}), stop({count, crossings, py::ssize_t{2}}), height(count),
      transmittance(count);
  const auto from = entrance_mm.unchecked<2>();
  auto to_sensor = sensor.mutable_unchecked<2>();
  auto to_stop = stop.mutable_unchecked<3>();
  auto to_height = height.mutable_unchecked<1>();
  auto to_transmittance = transmittance.mutable_unchecked<1>();
  for (py::ssize_t k = 0; k < count; ++k) {
    const PolynomialRay ray = ray_at(Vec2{from(k, 0), from(k, 1)});
    to_sensor(k, 0) = ray.sensor_mm.x;
    to_sensor(k, 1) = ray.sensor_mm.y;
    for (py::ssize_t c = 0; c < crossings; ++c) {
      to_stop(k, c, 0) = ray.stop[static_cast<std::size_t>(c)].x;
      to_stop(k, c, 1) = ray.stop[static_cast<std::size_t>(c)].y;
    }
    to_height(k) = ray.relative_height;
    to_transmittance(k) = ray.transmittance;
  }
  return py::make_tuple(sensor, stop, height, transmittance);
}

// In the light's meridional frame.
py::tuple evaluated(const AnyFit& fit, const std::vector<int>& surfaces, double field, const PointArray& entrance_mm,
                    double lambda_nm) {
  const PolynomialZone& zone = fitted_zone(fitted_ghost(fit, surfaces), field);
  return evaluated_at(entrance_mm, zone.stop.size(),
                      [&](Vec2 at) { return evaluate(*fit.state, zone, field, at, lambda_nm); });
}

// In the lens's frame, for ghosts without axial symmetry.
py::tuple evaluated_asymmetric(const AnyFit& fit, const std::vector<int>& surfaces,
                               const std::pair<double, double>& field, const PointArray& entrance_mm,
                               double lambda_nm) {
  const GhostPolynomials& ghost = fitted_ghost(fit, surfaces);
  const Vec2 tangents{field.first, field.second};
  const AsymmetricZone* const zone = find_zone(ghost, tangents).zone;
  if (zone == nullptr || zone->state != PolynomialZone::State::Fitted) throw py::value_error(kNotFitted);
  return evaluated_at(entrance_mm, zone->stop.size(),
                      [&](Vec2 at) { return *evaluate(*fit.state, ghost, tangents, at, lambda_nm); });
}

// field: a tangent, or those of both axes.
py::tuple evaluated_for(const AnyFit& fit, const std::vector<int>& surfaces,
                        const std::variant<double, std::pair<double, double>>& field, const PointArray& entrance_mm,
                        double lambda_nm) {
  if (const auto* const one = std::get_if<double>(&field))
    return evaluated(fit, surfaces, *one, entrance_mm, lambda_nm);
  return evaluated_asymmetric(fit, surfaces, std::get<std::pair<double, double>>(field), entrance_mm, lambda_nm);
}

const LensPolynomials& common_of(const AnyFit& fit) { return fit.state ? *fit.state : fit.range->common; }

}  // namespace

void add_polynomials(py::module_& module) {
  py::class_<AnyFit, FitPointer>(module, "Polynomials")
      .def_property_readonly("lens", [](const AnyFit& fit) { return common_of(fit).lens; })
      .def_property_readonly("is_range", [](const AnyFit& fit) { return fit.range != nullptr; })
      .def_property_readonly("max_field", [](const AnyFit& fit) { return common_of(fit).max_field; })
      .def_property_readonly("entrance_z_mm", [](const AnyFit& fit) { return common_of(fit).entrance_z_mm; })
      .def_property_readonly("traced_flux",
                             [](const AnyFit& fit) {
                               return fit.state ? traced_flux_fraction(*fit.state) : traced_flux_fraction(*fit.range);
                             })
      .def("ghosts", ghosts_of)
      .def("written", bytes_of)
      .def("at", fit_at, py::arg("lens"))
      .def("evaluate", evaluated_for, py::arg("ghost"), py::arg("field"), py::arg("entrance_mm"), py::arg("lambda_nm"));
  module.def("fit_polynomials", fit_state, py::arg("lens"), py::arg("values"), py::arg("half_field_rad"),
             py::arg("max_order"), py::arg("ghosts"), py::arg("progress"), py::arg("cancel"));
  module.def("fit_polynomial_range", fit_range, py::arg("lens"), py::arg("values"), py::arg("variable"),
             py::arg("ends_mm"), py::arg("half_field_rad"), py::arg("max_order"), py::arg("ghosts"),
             py::arg("progress"), py::arg("cancel"));
  module.def("read_polynomials", read_fit, py::arg("content"), py::arg("file"));
}

}  // namespace contrejour::python
