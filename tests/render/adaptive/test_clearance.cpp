// SPDX-License-Identifier: Apache-2.0
// Clearance traced in packets against trace(), ray by ray.
#include <algorithm>
#include <cmath>
#include <vector>

#include <doctest/doctest.h>

#include "optics/trace/clearance.h"
#include "render/adaptive/scene.h"

using namespace contrejour;

namespace {

constexpr std::size_t kSide = 33;

// The rays of a grid over the entrance window, whose last packet is not full.
struct Traced {
  EntranceWindow window;
  LightRays rays;
  std::vector<float> x_mm, y_mm;
  std::vector<std::vector<float>> fields;

  [[nodiscard]] Ray ray(std::size_t k) const {
    return {{rays.origin_mm.x + x_mm[k], rays.origin_mm.y + y_mm[k], rays.origin_mm.z}, rays.source.direction};
  }
};

Traced trace_window(const LensState& lens, const OpticalPath& path, Vec3 direction, PacketPrecision precision) {
  Traced t;
  t.window = entrance_window(lens, direction);
  t.rays = {{t.window.min_mm.x, t.window.min_mm.y, t.window.z_mm}, direction};
  const Vec2 step = (t.window.max_mm - t.window.min_mm) * (1.0 / (kSide - 1));
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    t.x_mm.push_back(static_cast<float>(static_cast<double>(k % kSide) * step.x));
    t.y_mm.push_back(static_cast<float>(static_cast<double>(k / kSide) * step.y));
  }
  t.x_mm.resize(t.x_mm.size() + kClearancePadding);
  t.y_mm.resize(t.x_mm.size());
  t.fields.assign(10, std::vector<float>(t.x_mm.size()));
  const auto f = [&](std::size_t k) { return t.fields[k].data(); };
  const ReflectanceTables tables(lens, path.lambda_nm);
  trace_clearance(PacketPath(path, tables, t.rays), precision, t.x_mm.data(), t.y_mm.data(), kSide * kSide,
                  {f(0), f(1), f(2), f(3), {f(4), f(6), f(8)}, {f(5), f(7), f(9)}});
  return t;
}

}  // namespace

TEST_CASE("clearance is what trace() says: who fails, how far out, where in the stop") {
  for (const auto& [precision, tolerance] :
       {std::pair{PacketPrecision::Float, 1e-3}, std::pair{PacketPrecision::Double, 1e-5}}) {
    for (const char* name : {"heliar", "muller-fisheye-10", "nikon-80-200"}) {
      CAPTURE(name);
      const LensState lens = test::lens_at_f(name, 8.0);
      const Vec3 direction = normalized({0.15, 0.0, 1.0});
      std::size_t passing = 0;
      std::size_t failing = 0;
      std::size_t differing = 0;
      double worst = 0.0;
      for (const Ghost ghost : enumerate_ghosts(lens, GhostScope::All)) {
        const OpticalPath path = ghost_path(lens, ghost, 550.0);
        const Traced t = trace_window(lens, path, direction, precision);
        for (std::size_t k = 0; k < kSide * kSide; ++k) {
          const TracedRay ray = trace(path, t.ray(k));
          const bool fails = t.fields[0][k] != 0.0F;
          ++(fails ? failing : passing);
          if (ray.status == RayStatus::Ok && ray.relative_height < 1.2) {
            if (fails) ++differing;
            worst = std::max(worst, std::abs(std::hypot(t.fields[2][k], t.fields[3][k]) - ray.relative_height));
            for (std::size_t c = 0; c < static_cast<std::size_t>(path.stop_crossings); ++c) {
              const Vec2 stop{t.fields[4 + 2 * c][k], t.fields[5 + 2 * c][k]};
              worst = std::max(worst, length(stop - ray.stop[c]));
            }
          }
          if (ray.status != RayStatus::Ok && !fails) ++differing;
        }
      }
      CHECK(passing > 200);
      CHECK(failing > 1000);
      CHECK(differing <= failing / 10000);  // by rounding, where a ray grazes
      CHECK(worst < tolerance);
    }
  }
}

TEST_CASE("rays that fail at the same test fail by what varies smoothly") {
  const LensState lens = test::lens_at_f("muller-fisheye-10", 8.0);
  const OpticalPath path = ghost_path(lens, {1, 4}, 550.0);
  const Traced t = trace_window(lens, path, normalized({0.4, 0.0, 1.0}), PacketPrecision::Float);
  double largest = 0.0;
  double sag = 0.0;
  for (std::size_t k = 1; k + 1 < kSide * kSide; ++k) {
    if (k % kSide == 0 || k % kSide == kSide - 1) continue;
    const auto& failing = t.fields[0];
    const auto& passed = t.fields[1];
    if (failing[k - 1] == 0.0F || failing[k] == 0.0F || failing[k + 1] == 0.0F) continue;
    if (passed[k - 1] != passed[k] || passed[k] != passed[k + 1] || passed[k] > 3.0F) continue;
    largest = std::max(largest, static_cast<double>(failing[k]));
    sag = std::max(sag, std::abs(0.5 * (failing[k - 1] + failing[k + 1]) - failing[k]));
  }
  CHECK(largest > 0.0);
  CHECK(sag < 0.2 * largest);
}
