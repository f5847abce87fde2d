// SPDX-License-Identifier: Apache-2.0
// Where a ghost's light enters: half of a grid compared with a whole one.
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "render/pupils/pupil_shape.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::pupils;

namespace {

double apart(const LinearMap& a, const LinearMap& b) {
  const LinearMap off = a - b;
  return std::sqrt((dot(off.x, off.x) + dot(off.y, off.y)) / (dot(b.x, b.x) + dot(b.y, b.y)));
}

}  // namespace

TEST_CASE("in a light's own frame, by half of the rays, a pupil is where it is in the lens's") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  int found = 0, whole = 0;
  for (const double rotation : {0.0, 0.4, 2.5, -1.2}) {
    const double tangent = 0.12;
    const LightSource source{normalized(Vec3{tangent * std::cos(rotation), tangent * std::sin(rotation), 1.0})};
    const EntranceWindow window = entrance_window(lens, source);
    for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::OneSideOfStop)) {
      CAPTURE(rotation);
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      const auto half = find_pupil_shape(steps, ghost, LightFrame(source, true), window);
      const auto all = find_pupil_shape(steps, ghost, LightFrame(source, false), window);
      REQUIRE(half.has_value() == all.has_value());
      if (!half || !half->is_open || !all->is_open) continue;
      ++found;
      whole += half->bound_fractions[0] > 0.85 && all->bound_fractions[0] > 0.85 ? 1 : 0;
      const double radius_mm = 2.0 * std::sqrt(0.5 * trace_of(all->covariance));
      CHECK(length(half->middle_mm - all->middle_mm) < 0.6 * radius_mm);
      CHECK(apart(half->covariance, all->covariance) < 0.25);
      CHECK(half->area_mm2 == doctest::Approx(all->area_mm2).epsilon(0.25));
      CHECK(half->border_mm == doctest::Approx(all->border_mm).epsilon(0.4));
      CHECK_FALSE(half->border.empty());
      for (const BorderPoint& point : half->border) CHECK(length(point.start_mm - all->middle_mm) < 3.0 * radius_mm);
    }
  }
  CHECK(found > 30);
  CHECK(whole > 10);
}
