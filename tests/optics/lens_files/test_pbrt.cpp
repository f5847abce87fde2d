// SPDX-License-Identifier: Apache-2.0
// Lenses of PBRT's realistic camera.
#include <doctest/doctest.h>

#include <filesystem>

#include "base/decode_text.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "optics/lens_files/read_lens.h"
#include "optics/lens_files/reader_checks.h"
#include "shared_data.h"
#include "support/approx.h"

namespace contrejour::test::pbrt {
namespace {

const std::string kSample =
    "# A SMALL LENS F/4\t\n"
    "# of nowhere\"\n"
    "# radius\tsep\tn\taperture\n"
    "50 5 1.6 20\n"
    "-60\t3\t1\t20  # the back\n"
    "0 2 0 10\n"
    "\n"
    "-40 2 1.5 14\r\n"
    "80 0 1 14";

void check_refused(const std::string& text, int line, const std::string& words) {
  const auto lens = read_pbrt({decode_text(text), "a.dat"});
  REQUIRE_FALSE(lens.has_value());
  CAPTURE(lens.error().to_string());
  CHECK(lens.error().message.find(words) != std::string::npos);
  CHECK(lens.error().position.line == line);
}

}  // namespace

TEST_CASE("a PBRT lens in every detail") {
  const auto lens = read_pbrt({decode_text(kSample), "a.dat"});
  REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
  CHECK(lens->name == "A SMALL LENS F/4");
  CHECK(lens->source == "of nowhere");
  REQUIRE(lens->surfaces.size() == 5);
  const auto& s = lens->surfaces;
  CHECK(s[0].curvature_per_mm == 1.0 / 50.0);
  CHECK(s[0].glass_after == Glass{"", ConstantIndex{1.6}});
  CHECK(is_air(s[1].glass_after));
  CHECK(s[2].kind == SurfaceKind::Stop);
  CHECK(s[2].semi_diameter_mm == 5.0);
  CHECK(is_air(s[2].glass_after));
  CHECK(s[4].source_line == 9);
  CHECK(looks_like_pbrt(kSample));
  CHECK_FALSE(looks_like_pbrt("# 1 2 3 4\n[lens]\n"));
  // Wide open, the stop has its full width.
  const auto state = configure_lens(*lens);
  REQUIRE(state.has_value());
  CHECK(state->stop_radius_mm == test::approx(5.0).epsilon(1e-6));
  CHECK(state->warnings.empty());
}

TEST_CASE("what is wrong with a PBRT lens, and where") {
  check_refused(kSample + "\n1 2 3", 10, "'1 2 3' is not a surface");
  check_refused(kSample + "\n1 2 3 4 5", 10, "is not a surface");
  check_refused(kSample + "\n1 2 x 4", 10, "is not a surface");
  check_refused(kSample + "\n1 2 inf 4", 10, "is not a surface");
  check_refused("-50 5 1.6 20\n60 3 1 20\n", 1, "no surface is the stop, and the lens forms no image");
  check_warns(read_or_fail(read_pbrt, "50 5 1.6 20\n-60 3 1 20\n"), "no surface is the stop");
  check_refused("", 0, "surface");
}

TEST_CASE("PBRT's samples: as their names say") {
  const std::pair<const char*, double> kLenses[] = {
      {"dgauss.50mm.dat", 50.0}, {"fisheye.10mm.dat", 10.0}, {"telephoto.250mm.dat", 250.0}, {"wide.22mm.dat", 22.0}};
  for (const auto& [name, focal_mm] : kLenses) {
    const auto path = shared_data(std::string("lenses/pbrt/") + name);
    if (!path) return;
    CAPTURE(std::string(name));
    const auto lens = read_lens(*path);
    REQUIRE_MESSAGE(lens.has_value(), (lens ? "" : lens.error().to_string()));
    const auto state = configure_lens(*lens);
    REQUIRE_MESSAGE(state.has_value(), (state ? "" : state.error().to_string()));
    CHECK(state->focal_length_mm == test::approx(focal_mm).epsilon(0.03));
    CHECK(lens->f_number > 1.5);
    CHECK(lens->f_number < 9.0);
  }
}

}  // namespace contrejour::test::pbrt
