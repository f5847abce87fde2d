// SPDX-License-Identifier: Apache-2.0
// Cells to primitives: validity, merging, failed rays, folds.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "render/tiled/scene.h"
#include "support/approx.h"

using namespace contrejour;
using tiled::Primitive;
using tiled::PrimitiveBuffer;

namespace {

TiledOptions merging(int steps, double threshold) {
  TiledOptions options;
  options.merge_steps = steps;
  options.merge_threshold = threshold;
  return options;
}

PrimitiveBuffer build(const RayGrid& grid, const Frame& frame, const TiledOptions& options,
                      std::uint64_t* before_merging = nullptr) {
  PrimitiveBuffer buffer;
  tiled::PrimitiveBuilder builder(frame, options);
  const auto count = builder.build(grid, {.pass = 5}, buffer);
  if (before_merging != nullptr) *before_merging = count;
  return buffer;
}

double total_flux(const PrimitiveBuffer& buffer) {
  double sum = 0.0;
  for (const Primitive& p : buffer.primitives) sum += test::flux_of(p);
  return sum;
}

bool is_sound(const Primitive& p) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (!std::isfinite(p.x[k] + p.y[k] + p.irradiance[k] + p.stop_x[k] + p.stop_y[k])) return false;
  }
  return p.pixels.empty() || test::triangle_area(p, 0, 1, 2) >= 0.0;
}

}  // namespace

TEST_CASE("a cell is kept when one of its rays gets through, and only then") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 320, 180);
  const RayGrid grid = test::traced(lens, {3, 4}, normalized({-0.1, -0.05, 1.0}), 40);
  std::size_t lit = 0;
  for (int iy = 0; iy < grid.cells(); ++iy) {
    for (int ix = 0; ix < grid.cells(); ++ix) {
      const auto v = grid.corners(ix, iy);
      lit += std::any_of(v.begin(), v.end(), [&](std::size_t k) { return grid.blocked[k] <= 0.0F; }) ? 1 : 0;
    }
  }
  const auto buffer = build(grid, frame, merging(0, 0.0));
  CHECK(buffer.primitives.size() == lit);
  CHECK(lit < static_cast<std::size_t>(grid.cells() * grid.cells()));
  for (const Primitive& p : buffer.primitives) {
    CHECK(p.pass == 5);
    CHECK(is_sound(p));
  }
}

TEST_CASE("merging keeps the flux and the count goes down with the threshold") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 1920, 1080);
  for (const Ghost ghost : {Ghost{3, 4}, Ghost{1, 2}, Ghost{7, 9}}) {
    const RayGrid grid = test::traced(lens, ghost, normalized({-0.1, -0.05, 1.0}), 100);
    std::uint64_t before = 0;
    const auto whole = build(grid, frame, merging(0, 0.0), &before);
    CHECK(whole.primitives.size() == before);
    std::size_t last = whole.primitives.size();
    for (const double threshold : {0.00001, 0.001, 0.1, 1e6}) {
      CAPTURE(threshold);
      std::uint64_t still_before = 0;
      const auto merged = build(grid, frame, merging(4, threshold), &still_before);
      CHECK(still_before == before);
      CHECK(merged.primitives.size() <= last);
      CHECK(total_flux(merged) / total_flux(whole) == test::approx(1.0).epsilon(2e-5));
      for (const Primitive& p : merged.primitives) CHECK(is_sound(p));
      last = merged.primitives.size();
    }
    CHECK(last < whole.primitives.size() / 4);
  }
}

TEST_CASE("a threshold of 0 merges nothing, no steps merge nothing") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 320, 180);
  const RayGrid grid = test::traced(lens, {3, 4}, normalized({-0.1, -0.05, 1.0}), 40);
  const auto whole = build(grid, frame, merging(0, 1e6));
  CHECK(build(grid, frame, merging(4, 0.0)).primitives.size() == whole.primitives.size());
}

TEST_CASE("a ray that failed takes its triangles with it and no more") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 320, 180);
  RayGrid grid = test::traced(lens, {3, 4}, normalized({-0.1, -0.05, 1.0}), 40);
  const auto whole = build(grid, frame, merging(0, 0.0));
  const std::size_t middle = grid.at(20, 20);
  REQUIRE(grid.blocked[middle] <= 0.0F);
  grid.relative_height[middle] = grid.blocked[middle] = std::numeric_limits<float>::infinity();
  grid.transmission[middle] = 0.0F;
  grid.sensor_x_mm[middle] = std::numeric_limits<float>::quiet_NaN();
  for (const int steps : {0, 4}) {
    const auto buffer = build(grid, frame, merging(steps, 0.001));
    for (const Primitive& p : buffer.primitives) CHECK(is_sound(p));
    if (steps > 0) continue;
    // Two of the four cells around it keep one triangle each, the other two none.
    CHECK(buffer.primitives.size() == whole.primitives.size() - 2);
    CHECK(total_flux(buffer) < total_flux(whole));
    CHECK(total_flux(buffer) > 0.99 * total_flux(whole));
  }
}

TEST_CASE("cells that are not convex become triangles with each its own flux") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 320, 180);
  RayGrid grid = test::traced(lens, {3, 4}, normalized({-0.1, -0.05, 1.0}), 40);
  const auto whole = build(grid, frame, merging(0, 0.0));
  std::swap(grid.sensor_x_mm[grid.at(20, 20)], grid.sensor_x_mm[grid.at(22, 20)]);
  std::swap(grid.sensor_y_mm[grid.at(20, 20)], grid.sensor_y_mm[grid.at(22, 20)]);
  const auto folded = build(grid, frame, merging(4, 1e6));
  int triangles = 0;
  for (const Primitive& p : folded.primitives) {
    CHECK(is_sound(p));
    triangles += (p.flags & tiled::kTriangle) != 0 ? 1 : 0;
  }
  CHECK(triangles >= 4);
  CHECK(total_flux(folded) / total_flux(whole) == test::approx(1.0).epsilon(1e-3));
}

TEST_CASE("a ghost in a single point has flux but no pixel, and breaks nothing") {
  const LensState lens = test::lens_at_f("heliar", 16.0);
  const Frame frame = frame_on_sensor(lens, 320, 180);
  RayGrid grid = test::traced(lens, {3, 4}, normalized({-0.1, -0.05, 1.0}), 40);
  std::fill(grid.sensor_x_mm.begin(), grid.sensor_x_mm.end(), 0.25F);
  std::fill(grid.sensor_y_mm.begin(), grid.sensor_y_mm.end(), 0.25F);
  for (const Primitive& p : build(grid, frame, merging(4, 0.001)).primitives) CHECK(p.pixels.empty());
}
