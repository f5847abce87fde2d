// SPDX-License-Identifier: Apache-2.0
// Measured coatings as files.
#include "contrejour/expert/coating_file.h"
#include "support/approx.h"

#include <doctest/doctest.h>

using namespace contrejour;

namespace {

void check_refused(std::string_view text, int line, std::string_view words) {
  const auto read = read_measured_coating(text, "r.csv");
  CAPTURE(text);
  REQUIRE_FALSE(read.has_value());
  CAPTURE(read.error().to_string());
  CHECK(read.error().position.line == line);
  CHECK(read.error().message.find(words) != std::string::npos);
}

}  // namespace

TEST_CASE("a table of reflectances is read whatever stands between, and means what it says") {
  for (const char* text :
       {"nm,0,60\n500,0.01,0.04\n600,0.02,0.06\n", "# a lens\r\n\r\nwavelength;0;60\r\n500;1e-2;.04\r\n600;.02;.06",
        "nm 0\t60\n500 0.01  0.04 # here\n600 0.02 0.06"}) {
    const auto read = read_measured_coating(text, "r.csv");
    REQUIRE_MESSAGE(read.has_value(), (read ? "" : read.error().to_string()));
    CHECK(*read == MeasuredCoating{{500, 600}, {0, 60}, {0.01, 0.04, 0.02, 0.06}});
  }
  const auto read = read_measured_coating("nm,0,60\n500,0.01,0.04\n600,0.02,0.06\n", "r.csv");
  const Coating coating{"", *read};
  CHECK(reflectance(coating, 1.0, 1.5, 1.0, 500.0) == test::approx(0.01));
  CHECK(reflectance(coating, 1.0, 1.5, 1.0, 525.0) == test::approx(0.0125));
  CHECK(reflectance(coating, 1.0, 1.5, 0.5, 600.0) == test::approx(0.06));
  CHECK(reflectance(coating, 1.0, 1.5, 1.0, 900.0) == test::approx(0.02));
}

TEST_CASE("what is no table of reflectances names its line") {
  check_refused("", 0, "no wavelength");
  check_refused("nm,0,60\n", 0, "no wavelength");
  check_refused("500,0.01\n", 1, "a word and");
  check_refused("nm\n", 1, "a word and");
  check_refused("nm,60,0\n", 1, "'0' is no angle");
  check_refused("nm,0,91\n", 1, "'91' is no angle");
  check_refused("nm,0,60\n500,0.01\n", 2, "2 numbers");
  check_refused("nm,0\n500,0.01,0.02\n", 2, "3 numbers");
  check_refused("nm,0\n500,0.01\n\n400,0.02\n", 4, "'400' is no wavelength");
  check_refused("nm,0\n5,0.01\n", 2, "'5' is no wavelength");
  check_refused("nm,0\n500,1.4\n", 2, "1 per cent is 0.01");
  check_refused("nm,0\n500,nan\n", 2, "'nan' is no reflectance");
  check_refused(std::string(2U << 20U, 'a'), 0, "larger than");
  std::string endless = "nm,0\n";
  for (int k = 0; k < 1001; ++k) endless += std::to_string(400 + k) + ",0.5\n";
  check_refused(endless, 1002, "no wavelength; let up to 1000");
}
