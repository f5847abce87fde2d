// SPDX-License-Identifier: Apache-2.0
// Rays in bulk, directions of lights, and the figures of ghosts.
#include <memory>
#include <utility>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/trace.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

// The results of n rays as arrays.
struct RayArrays {
  RayArrays(py::ssize_t n, int stop_crossings)
      : status(n), sensor_mm({n, py::ssize_t{2}}), direction({n, py::ssize_t{3}}), transmission(n), relative_height(n),
        blocked_by(n), stop({n, py::ssize_t{stop_crossings}, py::ssize_t{2}}) {}

  py::array_t<std::uint8_t> status;
  py::array_t<double> sensor_mm, direction, transmission, relative_height, blocked_by, stop;
};

// The memory of RayArrays, for use without Python's lock.
struct RayPointers {
  explicit RayPointers(RayArrays& arrays)
      : status(arrays.status.mutable_data()), sensor_mm(arrays.sensor_mm.mutable_data()),
        direction(arrays.direction.mutable_data()), transmission(arrays.transmission.mutable_data()),
        relative_height(arrays.relative_height.mutable_data()), blocked_by(arrays.blocked_by.mutable_data()),
        stop(arrays.stop.mutable_data()) {}

  void store(std::size_t k, const TracedRay& ray, double blocked) const {
    status[k] = static_cast<std::uint8_t>(ray.status);
    sensor_mm[2 * k] = ray.sensor_mm.x;
    sensor_mm[2 * k + 1] = ray.sensor_mm.y;
    direction[3 * k] = ray.direction.x;
    direction[3 * k + 1] = ray.direction.y;
    direction[3 * k + 2] = ray.direction.z;
    transmission[k] = ray.transmission;
    relative_height[k] = ray.relative_height;
    blocked_by[k] = blocked;
    for (std::size_t c = 0; c < crossings; ++c) {
      stop[2 * (crossings * k + c)] = ray.stop[c].x;
      stop[2 * (crossings * k + c) + 1] = ray.stop[c].y;
    }
  }

  std::uint8_t* status;
  double *sensor_mm, *direction, *transmission, *relative_height, *blocked_by, *stop;
  std::size_t crossings;
};

OpticalPath path_of(const LensState& lens, const std::vector<int>& surfaces, double lambda_nm) {
  const auto ghost = ghost_of(surfaces);
  if (!ghost) return direct_path(lens, lambda_nm);
  if (!has_ghost(lens, *ghost)) throw py::value_error("the lens has no ghost " + ghost_name(*ghost));
  return ghost_path(lens, *ghost, lambda_nm);
}

Vec3 vector_at(const double* numbers, std::size_t k) {
  return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
}

Vec3 direction_at(const double* numbers, std::size_t k) {
  const Vec3 given = vector_at(numbers, k);
  return dot(given, given) == 1.0 ? given : normalized(given);
}

py::tuple trace_rays(const LensState& lens, const std::vector<int>& surfaces, double lambda_nm,
                     const VectorArray& origins_mm, const VectorArray& directions) {
  const py::ssize_t n = check_vectors(origins_mm, "origins_mm");
  if (check_vectors(directions, "directions") != n)
    throw py::value_error("origins_mm and directions have different lengths");
  const OpticalPath path = path_of(lens, surfaces, lambda_nm);
  RayArrays arrays(n, path.stop_crossings);
  const RayPointers to(arrays);
  const double *const origin = origins_mm.data(), *const direction = directions.data();
  {
    const py::gil_scoped_release unlocked;
    for (std::size_t k = 0; k < static_cast<std::size_t>(n); ++k) {
      const TracedRay ray = trace(path, {vector_at(origin, k), direction_at(direction, k)});
      to.store(k, ray, blocked_by(ray, path, lens.iris));
    }
  }
  return py::make_tuple(arrays.status, arrays.sensor_mm, arrays.direction, arrays.transmission, arrays.relative_height,
                        arrays.blocked_by, arrays.stop);
}

py::dict dict_of(const GhostFigures& g) {
  py::dict fields;
  fields["surfaces"] = g.ghost.reflects_four_times() ? py::make_tuple(g.ghost.i, g.ghost.j, g.ghost.k, g.ghost.l)
                                                     : py::make_tuple(g.ghost.i, g.ghost.j);
  fields["relative_flux"] = g.relative_flux;
  fields["rgb"] = py::make_tuple(g.rgb[0], g.rgb[1], g.rgb[2]);
  fields["peak_irradiance"] = g.peak_irradiance;
  fields["reflectance"] = g.reflectance;
  fields["centroid_px"] = tuple_of(g.centroid_px);
  fields["size_px"] = tuple_of(g.size_px);
  fields["centroid_mm"] = tuple_of(g.centroid_mm);
  fields["size_mm"] = tuple_of(g.size_mm);
  fields["focus_mm"] = g.first_order.focus_mm;
  fields["blur_mm"] = g.first_order.blur_mm;
  fields["in_focus"] = g.in_focus;
  fields["pupil_ghost"] = g.pupil_ghost;
  return fields;
}

py::list ghosts(const LensState& lens, const params::Values& values, const std::optional<LightFields>& light,
                const py::object& progress) {
  std::optional<Light> given;
  if (light) given = light_of(*light);
  const FiguresRequest request = value_of(figures_request(values, lens, given ? &*given : nullptr));
  LongCall call(values.integer("threads"), progress);
  const auto figures = call.run([&](const Context& context) { return ghost_figures(lens, request, context); });
  py::list all;
  for (const GhostFigures& g : figures) all.append(dict_of(g));
  return all;
}

py::tuple direction_of_angles(double azimuth_rad, double elevation_rad) {
  constexpr double kLargest_rad = 1.569;  // 89.9 degrees: beyond, no light meets the front of a lens
  if (!(std::abs(azimuth_rad) <= kLargest_rad && std::abs(elevation_rad) <= kLargest_rad))
    throw py::value_error("a light at these angles is not in front of the camera; give at most 89.9 degrees");
  return tuple_of(direction_from_angles(azimuth_rad, elevation_rad));
}

}  // namespace

void add_rays(py::module_& module) {
  module.def("trace", trace_rays, py::arg("lens"), py::arg("ghost"), py::arg("lambda_nm"), py::arg("origins_mm"),
             py::arg("directions"));
  module.def("ghosts", ghosts, py::arg("lens"), py::arg("values"), py::arg("light"), py::arg("progress"));
  module.def("direction_from_angles", direction_of_angles, py::arg("azimuth_rad"), py::arg("elevation_rad"));
  module.def(
      "direction_for_image_point",
      [](const LensState& lens, double x_mm, double y_mm, double lambda_nm, double distance_mm) {
        return tuple_of(direction_for_image_point(lens, {x_mm, y_mm}, lambda_nm, distance_mm));
      },
      py::arg("lens"), py::arg("x_mm"), py::arg("y_mm"), py::arg("lambda_nm"), py::arg("distance_mm"));
}

}  // namespace contrejour::python
