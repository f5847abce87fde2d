// SPDX-License-Identifier: Apache-2.0
// Fringes of an edge: tabulated values of the Fresnel integrals, means, bands, and what ranges leave out.
#include <cmath>

#include <doctest/doctest.h>

#include "render/stop_patterns/edge_profile.h"
#include "support/approx.h"

using namespace contrejour;
using namespace contrejour::stop_patterns;

TEST_CASE("one wavelength: a quarter at the edge, 1.370 at 1.2172, 0.778 at 1.8725") {
  const EdgeProfile edge(0.0);
  CHECK(edge.at(0.0, 0.0) == test::approx(0.25).epsilon(2e-3));
  double best = 0.0, best_t = 0.0, smallest = 2.0, min_t = 0.0;
  for (double t = 0.0; t < 2.3; t += 1e-3) {
    const double v = edge.at(t, 0.0);
    if (v > best) best = v, best_t = t;
    if (t > 1.3 && v < smallest) smallest = v, min_t = t;
  }
  CHECK(best == test::approx(1.370).epsilon(2e-3));
  CHECK(best_t == test::approx(1.2172).epsilon(0.01));
  CHECK(smallest == test::approx(0.778).epsilon(3e-3));
  CHECK(min_t == test::approx(1.8725).epsilon(0.01));
  CHECK(edge.at(-2.0, 0.0) == test::approx(0.0120).epsilon(0.05));  // 1 / (2 pi^2 t^2), nearly
}

TEST_CASE("an edge takes no light: as much beyond it as is missing within") {
  for (const double spread : {0.0, 0.02, 0.1, 0.4}) {
    const EdgeProfile edge(spread);
    CHECK(200.0 * edge.at(0.0, 200.0) == test::approx(100.0).epsilon(1e-4));
  }
}

TEST_CASE("means over a width are means") {
  const EdgeProfile edge(0.03);
  for (const double t : {-5.9, -1.0, 0.3, 4.0, 31.9, 33.0}) {
    for (const double width : {0.003, 0.05, 0.7, 5.0}) {
      double sum = 0.0;
      for (int k = 0; k < 2000; ++k) sum += edge.at(t + width * ((k + 0.5) / 2000 - 0.5), 0.0) / 2000;
      CHECK(edge.at(t, width) == test::approx(sum).epsilon(1e-3).scale(1.0));
    }
  }
  CHECK(edge.at(-100.0, 1.0) == 0.0);
  CHECK(edge.at(100.0, 1.0) == 1.0);
}

TEST_CASE("a band blurs far fringes and keeps the first") {
  const EdgeProfile one(0.0), band(0.05);
  CHECK(band.at(1.22, 0.0) > 1.34);
  double far_one = 0.0, far_band = 0.0;
  for (double t = 8.0; t < 12.0; t += 0.01) {
    far_one = std::max(far_one, std::abs(one.at(t, 0.0) - 1.0));
    far_band = std::max(far_band, std::abs(band.at(t, 0.0) - 1.0));
  }
  CHECK(far_one > 0.03);
  CHECK(far_band < 0.01);
}

TEST_CASE("a range leaves out dim ripples only, and says how much they are") {
  const EdgeProfile edge(0.04);
  for (const double ripple : {0.1, 0.03, 0.005}) {
    const auto range = edge.range_above(ripple);
    double left = 0.0;
    for (double t = -6.0; t < 32.0; t += 1e-3) {
      const double v = edge.at(t, 0.0);
      if (t < range.dark) left += v * v * 1e-3;
      if (t > range.level) left += (v - 1.0) * (v - 1.0) * 1e-3;
      if (t < range.dark - 0.01) CHECK(v <= ripple);
      if (t > range.level + 0.01) CHECK(std::abs(v - 1.0) <= ripple);
    }
    CHECK(std::abs(edge.at(range.level - 0.02, 0.0) - 1.0) > 0.5 * ripple);  // and no more than necessary
    CHECK(edge.squared_error(range) == test::approx(left).epsilon(0.03));
  }
  CHECK(edge.range_above(2.0).level == 0.0);
  CHECK(edge.range_above(2.0).dark == 0.0);
}
