// SPDX-License-Identifier: Apache-2.0
// Rays in bulk for C callers.
#include <cstddef>

#include "c_interface/boundary.h"
#include "c_interface/optics_objects.h"
#include "contrejour/expert/trace.h"

namespace contrejour {
namespace {

static_assert(static_cast<int>(RayStatus::Ok) == CJ_RAY_OK && static_cast<int>(RayStatus::Missed) == CJ_RAY_MISSED &&
              static_cast<int>(RayStatus::TotalReflection) == CJ_RAY_TOTAL_REFLECTION &&
              static_cast<int>(RayStatus::NotFinite) == CJ_RAY_NOT_FINITE);

Result<OpticalPath> path_of_caller(const LensState& lens, const int32_t* surfaces, double wavelength_nm) {
  const auto lambda_nm = wavelength_of(lens, wavelength_nm);
  if (!lambda_nm) return tl::unexpected(lambda_nm.error());
  if (surfaces == nullptr) return direct_path(lens, *lambda_nm);
  const auto ghost = ghost_of_surfaces(lens, surfaces);
  if (!ghost) return tl::unexpected(ghost.error());
  return ghost_path(lens, *ghost, *lambda_nm);
}

cj_traced_ray ray_of(const TracedRay& traced, const OpticalPath& path, const Iris& iris) {
  cj_traced_ray ray{};
  ray.status = static_cast<cj_ray_status>(traced.status);
  ray.sensor_mm[0] = traced.sensor_mm.x;
  ray.sensor_mm[1] = traced.sensor_mm.y;
  ray.direction[0] = traced.direction.x;
  ray.direction[1] = traced.direction.y;
  ray.direction[2] = traced.direction.z;
  ray.transmission = traced.transmission;
  ray.relative_height = traced.relative_height;
  ray.blocked_by = blocked_by(traced, path, iris);
  return ray;
}

Vec3 vector_of(const double* numbers, std::size_t k) {
  return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
}

}  // namespace
}  // namespace contrejour

cj_status cj_trace(const cj_lens_state* state, const int32_t surfaces[4], double wavelength_nm,
                   const double* origins_mm, const double* directions, size_t count, cj_traced_ray* rays,
                   cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require_surfaces(state); !given) return given;
    if (count == 0) return {};
    if (const auto given = require(origins_mm, "origins_mm"); !given) return given;
    if (const auto given = require(directions, "directions"); !given) return given;
    if (const auto good = check_struct(rays, sizeof(cj_traced_ray), "cj_traced_ray"); !good) return good;
    const auto path = path_of_caller(state->state, surfaces, wavelength_nm);
    if (!path) return tl::unexpected(path.error());
    const std::size_t step = rays->struct_size;
    auto* const first = reinterpret_cast<std::byte*>(rays);
    for (std::size_t k = 0; k < count; ++k) {
      const TracedRay traced = trace(*path, {vector_of(origins_mm, k), normalized(vector_of(directions, k))});
      auto* const to = reinterpret_cast<cj_traced_ray*>(first + k * step);
      to->struct_size = step;
      write_struct(ray_of(traced, *path, state->state.iris), to);
    }
    return {};
  });
}
