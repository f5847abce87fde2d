// SPDX-License-Identifier: Apache-2.0
// Forbes' aspheres, against his own closed forms and a lens with one.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/trace.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "optics/lens_files/sequential/forbes.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::forbes {
namespace {

double term(ForbesKind kind, std::size_t m, double x) {
  ForbesAsphere one{kind, 1.0, std::vector<double>(m + 1, 0.0)};
  one.coefficients[m] = 1.0;
  return forbes_sum(one, x);
}

// A lens of a converging asphere and its plane back.
std::string zmx_with(const std::string& surface) {
  return "MODE SEQ\nUNIT MM X W X CM MR CPMM\nENPD 10\nWAVM 1 0.587562 1\nPWAV 1\nFTYP 0 0 1 1 0 0 0\nYFLN 0\nSURF 0\n"
         "  DISZ INFINITY\nSURF 1\n  STOP\n" +
         surface + "  DISZ 3\n  GLAS ___BLANK 1 0 1.5 60\n  DIAM 6 1\nSURF 2\n  CURV 0\n  DISZ 20\nSURF 3\n  DISZ 0\n";
}

}  // namespace

TEST_CASE("the first Q polynomials are those that Forbes prints") {
  for (double x = 0.0; x <= 1.0; x += 0.125) {
    CAPTURE(x);
    // Forbes 2007, (A.4) and the list of Qcon.
    CHECK(term(ForbesKind::Bfs, 0, x) == 1.0);
    CHECK(term(ForbesKind::Bfs, 1, x) == test::approx((13.0 - 16.0 * x) / std::sqrt(19.0)).epsilon(1e-13));
    CHECK(term(ForbesKind::Bfs, 2, x) ==
          test::approx(std::sqrt(2.0 / 95.0) * (29.0 - 4.0 * x * (25.0 - 19.0 * x))).epsilon(1e-13));
    CHECK(term(ForbesKind::Bfs, 3, x) ==
          test::approx(std::sqrt(2.0 / 2545.0) * (207.0 - 4.0 * x * (315.0 - x * (577.0 - 320.0 * x)))).epsilon(1e-13));
    CHECK(term(ForbesKind::Con, 0, x) == 1.0);
    CHECK(term(ForbesKind::Con, 1, x) == test::approx(6.0 * x - 5.0).epsilon(1e-13));
    CHECK(term(ForbesKind::Con, 2, x) == test::approx(15.0 - 14.0 * x * (3.0 - 2.0 * x)).epsilon(1e-13));
    CHECK(term(ForbesKind::Con, 3, x) ==
          test::approx(-(35.0 - 12.0 * x * (14.0 - x * (21.0 - 10.0 * x)))).epsilon(1e-13));
  }
}

TEST_CASE("slopes of Qbfs are orthogonal with their weight, sags of Qcon with theirs") {
  constexpr int kSamples = 20000;
  for (std::size_t m = 0; m < 9; ++m) {
    for (std::size_t n = 0; n <= m; ++n) {
      double slopes = 0.0, sags = 0.0;
      for (int k = 0; k < kSamples; ++k) {
        const double angle = 0.5 * std::acos(-1.0) * (k + 0.5) / kSamples, u = std::sin(angle), h = 1e-5;
        // Weight 1 / (u sqrt(1 - u^2)) du of the slopes is d(angle) / u; <...> is its mean with 2 / pi.
        const auto slope = [&](std::size_t of) {
          const auto s = [&](double at) { return at * at * (1.0 - at * at) * term(ForbesKind::Bfs, of, at * at); };
          return (s(u + h) - s(u - h)) / (2.0 * h);
        };
        slopes += slope(m) * slope(n) / kSamples;
        const double x = (k + 0.5) / kSamples;
        sags += std::pow(x, 4.0) * term(ForbesKind::Con, m, x) * term(ForbesKind::Con, n, x) / kSamples;
      }
      CAPTURE(m);
      CAPTURE(n);
      CHECK(slopes == test::approx(m == n ? 1.0 : 0.0).epsilon(1e-5));
      CHECK(sags == test::approx(m == n ? 1.0 / (2.0 * static_cast<double>(m) + 5.0) : 0.0).epsilon(1e-4));
    }
  }
}

TEST_CASE("even powers are the departure, along a sphere's normal or the axis") {
  const ForbesAsphere bfs{ForbesKind::Bfs, 8.0, {0.1, -0.03, 0.02, 0.004}};
  const double c = 1.0 / 20.0;
  const auto fitted = powers_of_forbes(c, 0.0, bfs, 7.0);
  REQUIRE(fitted.has_value());
  CHECK(fitted->off < 1e-9);
  for (const double r : {0.5, 3.0, 5.5, 7.0}) {
    double sum = 0.0;
    for (std::size_t k = 0; k < fitted->powers.size(); ++k) sum += fitted->powers[k] * std::pow(r, k + 1.0);
    const double u2 = r * r / 64.0;
    const double expected =
        u2 * (1.0 - u2) / std::sqrt(1.0 - c * c * r * r) *
        (0.1 - 0.03 * (13.0 - 16.0 * u2) / std::sqrt(19.0) +
         0.02 * std::sqrt(2.0 / 95.0) * (29.0 - 4.0 * u2 * (25.0 - 19.0 * u2)) +
         0.004 * std::sqrt(2.0 / 2545.0) * (207.0 - 4.0 * u2 * (315.0 - u2 * (577.0 - 320.0 * u2))));
    CHECK(sum == test::approx(expected).epsilon(1e-8));
  }
  CHECK(powers_of_forbes(c, 0.3, {ForbesKind::Con, 8.0, {0.1, 0.2}}, 7.0)->off < 1e-13);
  CHECK_FALSE(powers_of_forbes(c, 0.0, bfs, 21.0).has_value());
}

TEST_CASE("Zemax' Q-type surfaces: Qcon as the even asphere it is, and what is wrong with others") {
  const auto read = [](const std::string& surface) { return read_zmx({zmx_with(surface), "x.zmx"}); };
  const std::string con =
      "  TYPE QED_TYPE\n  CURV 0.05\n  XDAT 1 1\n  XDAT 2 2\n  XDAT 3 10\n  XDAT 4 0.2\n  XDAT 5 0.1\n";
  const auto lens = read(con);
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  const auto glass = std::ranges::find(lens->surfaces, SurfaceKind::Refracting, &Surface::kind);
  // u^4 (0.2 + 0.1 (6 u^2 - 5)) with u = r / 10.
  CHECK(glass->shape.powers[3] == test::approx(-0.3e-4).epsilon(1e-9));
  CHECK(glass->shape.powers[5] == test::approx(0.6e-6).epsilon(1e-9));
  const auto refused = [&](const std::string& surface, const std::string& words) {
    const auto none = read(surface);
    REQUIRE_FALSE(none.has_value());
    CHECK_MESSAGE(none.error().message.find(words) != std::string::npos, none.error().message);
  };
  refused("  TYPE QED_TYPE\n  CURV 0.05\n  XDAT 1 2\n  XDAT 3 10\n", "its type is 2");
  refused("  TYPE QED_TYPE\n  CURV 0.05\n  XDAT 2 1\n", "its norm radius is 0");
  refused("  TYPE QED_TYPE\n  CURV 0.05\n  XDAT 2 31\n  XDAT 3 10\n", "31 terms");
  refused("  TYPE QED_TYPE\n  CURV 0.2\n  XDAT 2 1\n  XDAT 3 10\n  XDAT 4 0.1\n", "its conic ends");
  refused("  TYPE QED_TYPE\n  CURV 0.05\n  XDAT 1 1\n  XDAT 2 21\n  XDAT 3 6\n  XDAT 24 0.1\n",
          "powers up to r^20 miss it");
}

TEST_CASE("a lens of Zemax' Qbfs brings all of its light to one point, as its maker says") {
  const auto folder = shared_data("lenses/rayoptics/zemax/tests");
  if (!folder) return;
  const auto lens = read_lens(*folder / "ASL5040-UV-Zemax(ZMX).zmx");
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  const auto state = configure_lens(*lens);
  REQUIRE(state.has_value());
  // The distance to the image that the lens states; rays miss the axis there by less than a ten-thousandth of the
  // lens's 46 mm.
  const OpticalPath path = direct_path(*state, 405.0);
  const double image_mm = state->surfaces.back().z_mm + 19.687453064998852;
  for (const double r : {1.0, 6.0, 12.0, 17.0, 20.0, 22.0}) {
    CAPTURE(r);
    const TracedRay ray = trace(path, {{0.0, r, -5.0}, {0.0, 0.0, 1.0}});
    REQUIRE(ray.status == RayStatus::Ok);
    const double y = ray.sensor_mm.y + (image_mm - state->sensor_z_mm) * ray.direction.y / ray.direction.z;
    CHECK(std::abs(y) < 1e-3);
  }
}

}  // namespace contrejour::test::forbes
