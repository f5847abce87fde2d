// SPDX-License-Identifier: Apache-2.0
// Rims that are not circles: rims_of() against elementary geometry, both tracers against points on the glass.
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/clear_aperture.h"
#include "optics/trace/clearance.h"
#include "optics/trace/packet_trace.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

// The definition: within the half sides in the aperture's own frame, and within the disc.
bool is_clear(const ClearAperture& a, double semi_diameter_mm, Vec2 at) {
  const Vec2 from = at - a.centre_mm;
  const double x = from.x * std::cos(a.rotation_rad) + from.y * std::sin(a.rotation_rad);
  const double y = -from.x * std::sin(a.rotation_rad) + from.y * std::cos(a.rotation_rad);
  const double u = x / a.half_mm.x, v = y / a.half_mm.y;
  const bool inside = a.kind == ApertureKind::Ellipse ? u * u + v * v <= 1.0 : std::abs(u) <= 1.0 && std::abs(v) <= 1.0;
  return inside && length(at) <= semi_diameter_mm;
}

const ClearAperture kApertures[] = {
    {ApertureKind::Ellipse, {6.0, 3.0}, {0.5, -0.4}, 0.3},
    {ApertureKind::Ellipse, {20.0, 4.0}, {}, -1.0},     // cut by the disc
    {ApertureKind::Rectangle, {5.0, 3.0}, {-0.3, 0.2}, 0.6},
    {ApertureKind::Rectangle, {9.0, 8.0}, {}, 0.0},     // its corners are the disc's
    {ApertureKind::Rectangle, {99.0, 2.0}, {}, 1.2},    // a slit
};

LensState heliar_with(const ClearAperture& front, const SurfacePose& pose = {}) {
  auto lens = find_lens("heliar");
  REQUIRE(lens.has_value());
  lens->surfaces.front().aperture = front;
  lens->surfaces.front().pose = pose;
  const auto state = configure_lens(*lens, {.f_number = 8.0});
  REQUIRE(state.has_value());
  return *state;
}

// The points where a ray meets the glass of surface 1, at each hit, in the surface's own coordinates.
std::vector<Vec2> crossings_of_front(const OpticalPath& path, const Ray& ray, const SurfacePose& pose) {
  std::vector<Vec2> out;
  for (const TraceStep& step : trace_recorded(path, ray).steps) {
    if (step.surface != 1) continue;
    const Vec3 from = step.position_mm - pose.shift_mm;
    // Rotated upright: by the smallest rotation that takes the axis to +z.
    const Vec3 a = pose.axis;
    const double t = (a.x * from.x + a.y * from.y) / (1.0 + a.z);
    out.push_back({from.x - a.x * (from.z + t), from.y - a.y * (from.z + t)});
  }
  return out;
}

OpticalPath path_of(const LensState& lens, const Ghost& ghost) {
  return ghost == Ghost{} ? direct_path(lens, 550.0) : ghost_path(lens, ghost, 550.0);
}

}  // namespace

TEST_CASE("an aperture's rims hold what lies within it and nothing else") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(-11.0, 11.0);
  for (const ClearAperture& aperture : kApertures) {
    const auto rims = rims_of(aperture, 10.0);
    REQUIRE_FALSE(rims.empty());
    int inside = 0;
    for (int k = 0; k < 5000; ++k) {
      const Vec2 at{coordinate(random), coordinate(random)};
      const bool clear = is_clear(aperture, 10.0, at);
      inside += clear ? 1 : 0;
      CHECK(std::ranges::all_of(rims, [&](const Rim& rim) { return length(rim.coordinates(at)) <= 1.0; }) == clear);
    }
    CHECK(inside > 100);
  }
  CHECK(rims_of({}, 10.0).empty());
  CHECK(rims_of(kApertures[0], 10.0).size() == 1);
  CHECK(rims_of(kApertures[2], 10.0).size() == 2);
  CHECK(rims_of(kApertures[3], 10.0).size() == 3);
}

TEST_CASE("rays pass a rim where they meet the glass within it, centred or not, in every tracer") {
  const SurfacePose askew{{0.4, -0.3, 0.0}, normalized({0.02, 0.03, 1.0})};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-13.0, 13.0);
  for (const SurfacePose& pose : {SurfacePose{}, askew}) {
    for (const ClearAperture& aperture : kApertures) {
      const LensState lens = heliar_with(aperture, pose);
      const LensState round = heliar_with({}, pose);
      CHECK_FALSE(lens.has_axial_symmetry());
      const double semi_mm = lens.surfaces.front().semi_diameter_mm;
      for (const Ghost& ghost : {Ghost{}, Ghost{1, 2}}) {
        const OpticalPath path = path_of(lens, ghost), plain = path_of(round, ghost);
        const ReflectanceTables tables(lens, 550.0);
        const PacketPath packets(path, tables, {{0, 0, -5.0}, LightSource{{0, 0, 1}}});
        int blocked = 0, open = 0;
        for (int k = 0; k < 300; ++k) {
          const Vec2 at{coordinate(random), coordinate(random)};
          const Ray ray{{at.x, at.y, -5.0}, {0, 0, 1}};
          const TracedRay through = trace(path, ray), before = trace(plain, ray);
          CHECK(through.status == before.status);
          if (through.status != RayStatus::Ok) continue;
          CHECK(through.sensor_mm.y == test::approx(before.sensor_mm.y).epsilon(1e-12));
          CHECK(through.transmission == test::approx(before.transmission).epsilon(1e-12));
          bool clear = before.relative_height <= 1.0;
          for (const Vec2 on_glass : crossings_of_front(plain, ray, pose))
            clear = clear && is_clear(aperture, semi_mm, on_glass);
          CHECK((through.relative_height <= 1.0) == clear);
          (clear ? open : blocked) += 1;

          const float x = static_cast<float>(at.x), y = static_cast<float>(at.y);
          float sx = 0, sy = 0, transmission = 0, relative_height = 0, px = 0, py = 0;
          TracedArrays out{&sx, &sy, &transmission, &relative_height, {&px}, {&py}, nullptr, 0};
          trace_packets(packets, PacketPrecision::Double, &x, &y, 1, out);
          CHECK(relative_height == test::approx(through.relative_height).epsilon(1e-4));
          CHECK(transmission == test::approx(through.transmission).epsilon(1e-3));

          std::vector<float> fields(7 * kClearancePadding), xs(kClearancePadding, x), ys(kClearancePadding, y);
          const auto field = [&](std::size_t n) { return fields.data() + n * kClearancePadding; };
          trace_clearance(packets, PacketPrecision::Double, xs.data(), ys.data(), 1,
                          {field(0), field(1), field(2), field(3), {field(4)}, {field(5)}});
          CHECK(std::hypot(*field(2), *field(3)) == test::approx(through.relative_height).epsilon(1e-3));
        }
        CHECK(open > 5);
        CHECK(blocked > 5);
      }
    }
  }
}

TEST_CASE("an obscuration blocks where light meets the glass within it, each time, in every tracer") {
  const SurfacePose askew{{0.4, -0.3, 0.0}, normalized({0.02, 0.03, 1.0})};
  const Obscuration obscurations[] = {{{3.0, 3.0}, {}, 0.0}, {{4.0, 1.5}, {1.0, -0.5}, 0.4}};
  std::mt19937 random(6);
  std::uniform_real_distribution<double> coordinate(-9.0, 9.0);
  for (const SurfacePose& pose : {SurfacePose{}, askew}) {
    for (const Obscuration& obscuration : obscurations) {
      const LensState round = heliar_with({}, pose);
      LensState lens = round;
      lens.surfaces.front().obscuration = obscuration;
      CHECK(lens.has_axial_symmetry() == (pose == SurfacePose{} && obscuration.has_axial_symmetry()));
      const ClearAperture same{ApertureKind::Ellipse, obscuration.half_mm, obscuration.centre_mm,
                               obscuration.rotation_rad};
      for (const Ghost& ghost : {Ghost{}, Ghost{1, 2}}) {
        const OpticalPath path = path_of(lens, ghost), plain = path_of(round, ghost);
        const ReflectanceTables tables(lens, 550.0);
        const PacketPath packets(path, tables, {{0, 0, -5.0}, LightSource{{0, 0, 1}}});
        int obscured = 0, free = 0;
        for (int k = 0; k < 300; ++k) {
          const Vec2 at{coordinate(random), coordinate(random)};
          const Ray ray{{at.x, at.y, -5.0}, {0, 0, 1}};
          const TracedRay through = trace(path, ray), before = trace(plain, ray);
          const TracedRay searched = trace(without_obscurations(path), ray);
          CHECK(through.status == before.status);
          if (through.status != RayStatus::Ok) continue;
          CHECK(through.relative_height == test::approx(before.relative_height).epsilon(1e-12));
          CHECK(through.transmission == test::approx(before.transmission).epsilon(1e-12));
          CHECK(searched.obscured < 0.0);
          CHECK(searched.relative_height == before.relative_height);  // the same steps
          bool meets = false;
          for (const Vec2 on_glass : crossings_of_front(plain, ray, pose))
            meets = meets || is_clear(same, 1e3, on_glass);
          CHECK((through.obscured > 0.0) == meets);
          CHECK((blocked_by(through, path, Iris{}) > 0.0) == (meets || blocked_by(before, plain, Iris{}) > 0.0));
          (meets ? obscured : free) += 1;

          const float x = static_cast<float>(at.x), y = static_cast<float>(at.y);
          float sx = 0, sy = 0, transmission = 0, relative_height = 0, px = 0, py = 0;
          std::vector<float> squared(path.steps.size());
          trace_packets(packets, PacketPrecision::Double, &x, &y, 1,
                        {&sx, &sy, &transmission, &relative_height, {&px}, {&py}, squared.data(), 1});
          const double p = 1.0 - through.obscured;
          CHECK(relative_height == test::approx(std::max(through.relative_height, 2.0 - p)).epsilon(1e-4));
          CHECK(transmission == test::approx(through.transmission).epsilon(1e-3));
          double largest_excess = -1e30;
          for (std::size_t step = 0; step < path.steps.size(); ++step)
            if (path.steps[step].blocks_within)
              largest_excess = std::max(largest_excess, static_cast<double>(squared[step]));
          if (p > 1e-3 && p < 2.0) CHECK(largest_excess == test::approx(2.0 - p * p).epsilon(1e-3));
        }
        CHECK(obscured > 5);
        CHECK(free > 5);
      }
    }
  }
}
