// SPDX-License-Identifier: Apache-2.0
// Many rays along one path, from arrays of numbers into arrays of numbers: what trace() gives for each, bit for bit, on
// several threads. Errors: InvalidArgument for arrays whose sizes do not fit together; Cancelled, after which the
// results are written in part. Thread-safety: a pure function, but for the arrays that it writes.
#pragma once

#include <cstddef>
#include <span>

#include "contrejour/context.h"
#include "contrejour/expert/iris.h"
#include "contrejour/expert/trace.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// n rays. Directions may have any length but 0.
struct RayArrays {
  std::span<const double> origins_mm;  // 3 n: x, y, z of each ray
  std::span<const double> directions;  // 3 n
};

// The members of TracedRay and blocked_by() for n rays.
struct TracedRayArrays {
  std::span<RayStatus> status;  // n
  std::span<double> sensor_mm;  // 2 n
  std::span<double> direction;  // 3 n
  std::span<double> transmission;  // n
  std::span<double> relative_height;  // n
  std::span<double> blocked_by;  // n
  std::span<double> stop;  // 2 n recorded_crossings(path): x and y of each crossing
};

// How many stop crossings of a ray along the path TracedRay::stop has.
[[nodiscard]] CONTREJOUR_API std::size_t recorded_crossings(const OpticalPath& path);

[[nodiscard]] CONTREJOUR_API Result<void> trace_rays(const OpticalPath& path, const Iris& iris, const RayArrays& rays,
                                                     const TracedRayArrays& traced, const Context& context = {});

}  // namespace contrejour
