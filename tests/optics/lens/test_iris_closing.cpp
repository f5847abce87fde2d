// SPDX-License-Identifier: Apache-2.0
// Blades as functions of the f-number, and invalid irises.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/lens.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

constexpr double kWidest = 0.0;

LensState heliar(double f_number, const Iris& iris, IrisClosing closing) {
  const auto lens = find_lens("heliar");
  REQUIRE(lens.has_value());
  const auto state = configure_lens(
      *lens, {.f_number = f_number > 0.0 ? f_number : lens->f_number, .iris = iris, .iris_closing = closing});
  REQUIRE(state.has_value());
  return *state;
}

double open_mm2(const LensState& lens) {
  return iris_area_fraction(lens.iris) * kPi * lens.stop_radius_mm * lens.stop_radius_mm;
}

}  // namespace

TEST_CASE("a mechanism is round wide open") {
  const LensState round = heliar(kWidest, {}, IrisClosing::Scaled);
  const LensState blades = heliar(kWidest, {7, 0.3, 0.2}, IrisClosing::Mechanism);
  CHECK(blades.stop_radius_mm == round.stop_radius_mm);
  CHECK(IrisOpening(blades.iris).edges().size() == 1);
}

TEST_CASE("a mechanism keeps the f-number's area, whatever its blades") {
  for (const Iris& iris : {Iris{5}, Iris{9, 0.3, 0.4}, Iris{7, 0.1, 0.2, 1.0, 0.1, 3}, Iris{3, 0.0, 0.0, 1.0, 0.5, 1},
                           Iris{20, 0.0, 0.9}, Iris{6, 0.0, 1.0}}) {
    for (const double f_number : {4.6, 5.0, 5.6, 8.0, 11.0, 22.0, 100.0}) {
      CAPTURE(iris.blades);
      CAPTURE(f_number);
      const LensState round = heliar(f_number, {}, IrisClosing::Scaled);
      const LensState blades = heliar(f_number, iris, IrisClosing::Mechanism);
      CHECK(open_mm2(blades) / open_mm2(round) == test::approx(1.0).epsilon(1e-9));
      CHECK(blades.f_number == f_number);
      CHECK(blades.stop_radius_mm >= round.stop_radius_mm * (1.0 - 1e-9));
      CHECK(IrisOpening(blades.iris).outer_radius() == test::approx(1.0).epsilon(1e-9));
    }
  }
}

TEST_CASE("as a mechanism closes, the rim goes and the blades' polygon stays") {
  const double hole_mm = heliar(kWidest, {}, IrisClosing::Scaled).stop_radius_mm;
  const LensState slightly = heliar(3.6, {6}, IrisClosing::Mechanism);
  CHECK(slightly.stop_radius_mm == test::approx(hole_mm));
  CHECK(slightly.iris.blade_radius > 1.0);
  CHECK(IrisOpening(slightly.iris).edges().size() == 12);
  const LensState closed = heliar(11.0, {6}, IrisClosing::Mechanism);
  CHECK(closed.iris.blade_radius == 1.0);
  CHECK(IrisOpening(closed.iris).edges().size() == 6);
  // A hexagon of the circle's area: 3 sqrt(3) / 2 b^2 = pi r^2.
  const double round_mm = heliar(11.0, {}, IrisClosing::Scaled).stop_radius_mm;
  CHECK(closed.stop_radius_mm / round_mm == test::approx(std::sqrt(2.0 * kPi / (3.0 * std::sqrt(3.0)))).epsilon(1e-9));
}

TEST_CASE("scaled blades have their corners on the round stop's rim") {
  for (const double f_number : {4.5, 11.0}) {
    const LensState round = heliar(f_number, {}, IrisClosing::Scaled);
    const LensState blades = heliar(f_number, {6, 0.2, 0.3}, IrisClosing::Scaled);
    CHECK(blades.stop_radius_mm == round.stop_radius_mm);
    CHECK(blades.iris == Iris{6, 0.2, 0.3});
  }
}

TEST_CASE("irises that are none are refused") {
  const auto lens = find_lens("heliar");
  REQUIRE(lens.has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Iris& iris :
       {Iris{101}, Iris{5, nan}, Iris{5, 1e9}, Iris{5, 0.0, -0.1}, Iris{5, 0.0, 1.1}, Iris{5, 0.0, nan},
        Iris{5, 0.0, 0.0, 0.0}, Iris{5, 0.0, 0.0, nan}, Iris{5, 0.0, 0.0, 1.0, 0.6}, Iris{5, 0.0, 0.0, 1.0, nan},
        Iris{3, 0.0, 0.0, 1.0, 0.0, 0, {nan}}, Iris{4, 0.0, 0.0, 1.0, 0.0, 0, {-1.9, 0.0, -1.9, 0.0}}})
    for (const IrisClosing closing : {IrisClosing::Scaled, IrisClosing::Mechanism})
      CHECK_FALSE(configure_lens(*lens, {.iris = iris, .iris_closing = closing}).has_value());
}
