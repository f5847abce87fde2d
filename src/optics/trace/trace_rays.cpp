// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/trace_rays.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/tasks.h"
#include "optics/trace/scalar_trace-inl.h"

namespace contrejour {
namespace {

// A chunk takes about two milliseconds: long beside the start of a task, and short beside a caller's patience.
constexpr std::size_t kRaysInChunk = 4096;

Vec3 vector_at(std::span<const double> numbers, std::size_t k) {
  return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]};
}

Vec3 direction_at(std::span<const double> numbers, std::size_t k) {
  const Vec3 given = vector_at(numbers, k);
  return dot(given, given) == 1.0 ? given : normalized(given);
}

// Writes the results of single rays. The arrays' sizes have been checked.
class RayWriter {
 public:
  RayWriter(const OpticalPath& path, const TracedRayArrays& to)
      : status_(to.status.data()), sensor_mm_(to.sensor_mm.data()), direction_(to.direction.data()),
        transmission_(to.transmission.data()), relative_height_(to.relative_height.data()),
        blocked_by_(to.blocked_by.data()), stop_(to.stop.data()), crossings_(recorded_crossings(path)) {}

  void write(std::size_t k, const TracedRay& ray, double blocked) const {
    status_[k] = ray.status;
    sensor_mm_[2 * k] = ray.sensor_mm.x;
    sensor_mm_[2 * k + 1] = ray.sensor_mm.y;
    direction_[3 * k] = ray.direction.x;
    direction_[3 * k + 1] = ray.direction.y;
    direction_[3 * k + 2] = ray.direction.z;
    transmission_[k] = ray.transmission;
    relative_height_[k] = ray.relative_height;
    blocked_by_[k] = blocked;
    double* const stop = stop_ + 2 * crossings_ * k;
    for (std::size_t c = 0; c < crossings_; ++c) {
      stop[2 * c] = ray.stop[c].x;
      stop[2 * c + 1] = ray.stop[c].y;
    }
  }

 private:
  RayStatus* status_;
  double *sensor_mm_, *direction_, *transmission_, *relative_height_, *blocked_by_, *stop_;
  std::size_t crossings_;
};

Result<void> check_size(const char* name, std::size_t size, std::size_t expected) {
  if (size == expected) return {};
  return invalid_argument(fmt::format("the array {} has {} elements and not {}", name, size, expected));
}

Result<void> check_sizes(const OpticalPath& path, const RayArrays& rays, const TracedRayArrays& traced) {
  const std::size_t n = rays.origins_mm.size() / 3;
  const struct {
    const char* name;
    std::size_t size, expected;
  } arrays[] = {{"origins_mm", rays.origins_mm.size(), 3 * n},
                {"directions", rays.directions.size(), 3 * n},
                {"status", traced.status.size(), n},
                {"sensor_mm", traced.sensor_mm.size(), 2 * n},
                {"direction", traced.direction.size(), 3 * n},
                {"transmission", traced.transmission.size(), n},
                {"relative_height", traced.relative_height.size(), n},
                {"blocked_by", traced.blocked_by.size(), n},
                {"stop", traced.stop.size(), 2 * recorded_crossings(path) * n}};
  for (const auto& array : arrays)
    if (auto good = check_size(array.name, array.size, array.expected); !good) return good;
  return {};
}

}  // namespace

std::size_t recorded_crossings(const OpticalPath& path) {
  return static_cast<std::size_t>(std::min(path.stop_crossings, kMaxStopCrossings));
}

Result<void> trace_rays(const OpticalPath& path, const Iris& iris, const RayArrays& rays, const TracedRayArrays& traced,
                        const Context& context) {
  if (auto good = check_sizes(path, rays, traced); !good) return good;
  const RayWriter writer(path, traced);
  const std::size_t n = traced.status.size();
  const bool done = parallel_for((n + kRaysInChunk - 1) / kRaysInChunk, context, [&](std::size_t chunk) {
    const std::size_t last = std::min(n, (chunk + 1) * kRaysInChunk);
    for (std::size_t k = chunk * kRaysInChunk; k < last; ++k) {
      const Ray ray{vector_at(rays.origins_mm, k), direction_at(rays.directions, k)};
      const auto state = scalar_trace::trace_all(path, ray);
      writer.write(k, state.out, blocked_by(state.out, path, iris));
    }
  });
  if (!done) return interrupted();
  return {};
}

}  // namespace contrejour
