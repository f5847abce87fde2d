// SPDX-License-Identifier: Apache-2.0
// Rays in bulk, directions of lights, and the figures of ghosts.
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "contrejour/expert/requests.h"
#include "contrejour/expert/trace.h"
#include "contrejour/expert/trace_rays.h"
#include "native/arrays.h"
#include "native/errors.h"
#include "native/long_call.h"
#include "native/objects.h"

namespace contrejour::python {
namespace {

// The results of n rays, as the arrays of Python's TracedRays in its order. New ones lie in one block of memory, which
// the system then gives in large pages: eighty bytes a ray in small pages cost a tenth of the rays' time.
class ResultArrays {
 public:
  ResultArrays(std::size_t rays, std::size_t crossings) {
    const auto n = static_cast<py::ssize_t>(rays);
    const std::size_t numbers = 2 + 3 + 1 + 1 + 1 + 2 * crossings;
    std::byte* const memory = new_block(rays * (numbers * sizeof(double) + 1));
    double* next = reinterpret_cast<double*>(memory);
    const auto take = [&](std::vector<py::ssize_t> shape, std::size_t a_ray) {
      arrays_.append(py::array_t<double>(std::move(shape), std::exchange(next, next + a_ray * rays), owner_));
    };
    arrays_.append(py::array_t<std::uint8_t>(n, reinterpret_cast<std::uint8_t*>(next + numbers * rays), owner_));
    take({n, 2}, 2);
    take({n, 3}, 3);
    for (int k = 0; k < 3; ++k) take({n}, 1);
    take({n, static_cast<py::ssize_t>(crossings), 2}, 2 * crossings);
  }

  // Arrays of an earlier call, to be written again. Errors: others than those of these rays.
  ResultArrays(const py::sequence& earlier, std::size_t rays, std::size_t crossings) {
    const ResultArrays wanted(0, crossings);
    if (py::len(earlier) != py::len(wanted.arrays_)) throw py::type_error("out: not the arrays of a TracedRays");
    for (std::size_t k = 0; k < py::len(earlier); ++k) {
      const auto given = py::reinterpret_borrow<py::object>(earlier[k]);
      check(given, wanted.arrays_[k].cast<py::array>(), static_cast<py::ssize_t>(rays));
      arrays_.append(given);
    }
  }

  [[nodiscard]] TracedRayArrays views() const {
    const auto status = arrays_[0].cast<py::array>();
    return {{static_cast<RayStatus*>(const_cast<void*>(status.data())), static_cast<std::size_t>(status.size())},
            numbers(1),
            numbers(2),
            numbers(3),
            numbers(4),
            numbers(5),
            numbers(6)};
  }

  [[nodiscard]] py::tuple tuple() const { return py::tuple(arrays_); }

 private:
  static void check(const py::object& given, const py::array& wanted, py::ssize_t rays) {
    if (!py::isinstance<py::array>(given)) throw py::type_error("out: not the arrays of a TracedRays");
    const auto array = given.cast<py::array>();
    bool fits = array.dtype().is(wanted.dtype()) && array.ndim() == wanted.ndim() && array.writeable() &&
                (array.flags() & py::array::c_style) != 0 && array.shape(0) == rays;
    for (py::ssize_t d = 1; fits && d < wanted.ndim(); ++d) fits = array.shape(d) == wanted.shape(d);
    if (!fits) throw py::value_error("out: results of another number of rays, or of another path's stop crossings");
  }

  [[nodiscard]] std::span<double> numbers(std::size_t k) const {
    const auto array = arrays_[k].cast<py::array>();
    return {static_cast<double*>(const_cast<void*>(array.data())), static_cast<std::size_t>(array.size())};
  }

  std::byte* new_block(std::size_t bytes) {
    auto block = std::make_unique<Block>(bytes);
    std::byte* const memory = block->data();
    owner_ = py::capsule(block.get(), [](void* memory_block) { delete static_cast<Block*>(memory_block); });
    static_cast<void>(block.release());
    return memory;
  }

  using Block = std::vector<std::byte, PixelAllocator<std::byte>>;
  py::object owner_;
  py::list arrays_;
};

OpticalPath path_of(const LensState& lens, const std::vector<int>& surfaces, double lambda_nm) {
  const auto ghost = ghost_of(surfaces);
  if (!ghost) return direct_path(lens, lambda_nm);
  if (!has_ghost(lens, *ghost)) throw py::value_error("the lens has no ghost " + ghost_name(*ghost));
  return ghost_path(lens, *ghost, lambda_nm);
}

std::span<const double> numbers_of(const VectorArray& vectors) {
  return {vectors.data(), static_cast<std::size_t>(vectors.size())};
}

py::tuple trace(const LensState& lens, const std::vector<int>& surfaces, double lambda_nm,
                const VectorArray& origins_mm, const VectorArray& directions, const params::Values& values,
                const std::optional<py::sequence>& out, const py::object& progress, CancelFlag* cancel) {
  const auto n = static_cast<std::size_t>(check_vectors(origins_mm, "origins_mm"));
  if (static_cast<std::size_t>(check_vectors(directions, "directions")) != n)
    throw py::value_error("origins_mm and directions have different lengths");
  const OpticalPath path = path_of(lens, surfaces, lambda_nm);
  const std::size_t crossings = recorded_crossings(path);
  const ResultArrays results = out ? ResultArrays(*out, n, crossings) : ResultArrays(n, crossings);
  const RayArrays rays{numbers_of(origins_mm), numbers_of(directions)};
  const TracedRayArrays traced = results.views();
  LongCall call(values.integer("threads"), {progress, cancel});
  call.run([&](const Context& context) { return trace_rays(path, lens.iris, rays, traced, context); });
  return results.tuple();
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
                const py::object& progress, CancelFlag* cancel) {
  std::optional<Light> given;
  if (light) given = light_of(*light);
  const FiguresRequest request = value_of(figures_request(values, lens, given ? &*given : nullptr));
  LongCall call(values.integer("threads"), {progress, cancel});
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
  module.def("trace", trace, py::arg("lens"), py::arg("ghost"), py::arg("lambda_nm"), py::arg("origins_mm"),
             py::arg("directions"), py::arg("values"), py::arg("out"), py::arg("progress"), py::arg("cancel"));
  module.def("ghosts", ghosts, py::arg("lens"), py::arg("values"), py::arg("light"), py::arg("progress"),
             py::arg("cancel"));
  module.def("direction_from_angles", direction_of_angles, py::arg("azimuth_rad"), py::arg("elevation_rad"));
  module.def(
      "direction_for_image_point",
      [](const LensState& lens, double x_mm, double y_mm, double lambda_nm, double distance_mm) {
        return tuple_of(direction_for_image_point(lens, {x_mm, y_mm}, lambda_nm, distance_mm));
      },
      py::arg("lens"), py::arg("x_mm"), py::arg("y_mm"), py::arg("lambda_nm"), py::arg("distance_mm"));
}

}  // namespace contrejour::python
