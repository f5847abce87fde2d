// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/trace_rays.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// Rays that pass, that miss, that are blocked and that are no rays, with directions of several lengths.
struct Rays {
  explicit Rays(std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(count);
      origins_mm.insert(origins_mm.end(), {16.0 * t - 8.0, 2.0 * std::sin(40.0 * t), -20.0});
      directions.insert(directions.end(), {0.02 * std::cos(9.0 * t), 0.01 - 0.02 * t, k % 7 == 0 ? 3.0 : 1.0});
    }
    directions[3] = std::nan("");
  }
  [[nodiscard]] RayArrays arrays() const { return {origins_mm, directions}; }

  std::vector<double> origins_mm, directions;
};

struct Traced {
  Traced(std::size_t n, const OpticalPath& path)
      : status(n, RayStatus::NotFinite), sensor_mm(2 * n), direction(3 * n), transmission(n), height(n), blocked(n),
        stop(2 * n * recorded_crossings(path)) {}
  [[nodiscard]] TracedRayArrays arrays() { return {status, sensor_mm, direction, transmission, height, blocked, stop}; }

  std::vector<RayStatus> status;
  std::vector<double> sensor_mm, direction, transmission, height, blocked, stop;
};

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b)); }

bool same_ray(Traced& all, std::size_t k, const TracedRay& ray, double blocked, std::size_t crossings) {
  bool same =
      all.status[k] == ray.status && same_bits(all.sensor_mm[2 * k], ray.sensor_mm.x) &&
      same_bits(all.sensor_mm[2 * k + 1], ray.sensor_mm.y) && same_bits(all.direction[3 * k], ray.direction.x) &&
      same_bits(all.direction[3 * k + 2], ray.direction.z) && same_bits(all.transmission[k], ray.transmission) &&
      same_bits(all.height[k], ray.relative_height) && same_bits(all.blocked[k], blocked);
  for (std::size_t c = 0; c < crossings; ++c)
    same = same && same_bits(all.stop[2 * (crossings * k + c)], ray.stop[c].x) &&
           same_bits(all.stop[2 * (crossings * k + c) + 1], ray.stop[c].y);
  return same;
}

}  // namespace

TEST_CASE("rays in arrays are those of trace(), bit for bit, on any number of threads (threads)") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const std::size_t n = 9000;  // more than two chunks
  const Rays rays(n);
  for (const OpticalPath& path : {direct_path(lens, 500.0), ghost_path(lens, {2, 5}, 600.0)}) {
    for (const int threads : {1, 3}) {
      Traced traced(n, path);
      Context context;
      context.threads = threads;
      REQUIRE(trace_rays(path, lens.iris, rays.arrays(), traced.arrays(), context).has_value());
      std::size_t differing = 0, passing = 0;
      for (std::size_t k = 0; k < n; ++k) {
        const Vec3 direction{rays.directions[3 * k], rays.directions[3 * k + 1], rays.directions[3 * k + 2]};
        const Vec3 origin{rays.origins_mm[3 * k], rays.origins_mm[3 * k + 1], rays.origins_mm[3 * k + 2]};
        const TracedRay ray = trace(path, {origin, normalized(direction)});
        const double blocked = blocked_by(ray, path, lens.iris);
        if (!same_ray(traced, k, ray, blocked, recorded_crossings(path))) ++differing;
        if (ray.status == RayStatus::Ok && blocked <= 0.0) ++passing;
      }
      CHECK(differing == 0);
      CHECK(passing > 100);
      CHECK(passing < n - 100);
      CHECK(traced.status[1] == RayStatus::NotFinite);
    }
  }
}

TEST_CASE("arrays of rays whose sizes do not fit are refused, and a cancelled call says so") {
  const LensState lens = test::bundled("heliar", {});
  const OpticalPath path = direct_path(lens, 550.0);
  Rays rays(10);
  Traced traced(10, path);
  traced.blocked.resize(9);
  const auto refused = trace_rays(path, lens.iris, rays.arrays(), traced.arrays());
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::InvalidArgument);
  CHECK(refused.error().message.find("blocked_by") != std::string::npos);
  traced.blocked.resize(10);
  rays.directions.pop_back();
  CHECK_FALSE(trace_rays(path, lens.iris, rays.arrays(), traced.arrays()).has_value());
  rays.directions.push_back(1.0);
  const std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  const auto cancelled = trace_rays(path, lens.iris, rays.arrays(), traced.arrays(), context);
  REQUIRE_FALSE(cancelled.has_value());
  CHECK(cancelled.error().code == ErrorCode::Cancelled);
  CHECK(trace_rays(path, lens.iris, {}, Traced(0, path).arrays()).has_value());
}
