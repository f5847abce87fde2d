// SPDX-License-Identifier: Apache-2.0
#include "contrejour/result.h"

#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "base/memory.h"
#include "base/units.h"
#include "support/approx.h"

namespace contrejour {
namespace {

Result<double> halve(double x) {
  if (x < 0) return failure(ErrorCode::InvalidArgument, "x is negative: give 0 or more", {"lens.toml", 12, 3});
  return x / 2;
}

TEST_CASE("an error names file and line as far as they are known") {
  CHECK(Error{ErrorCode::Parse, "no stop", {"lens.toml", 7, 2}}.to_string() == "lens.toml:7: no stop");
  CHECK(Error{ErrorCode::Io, "cannot open it", {"lens.toml", 0, 0}}.to_string() == "lens.toml: cannot open it");
  CHECK(Error{ErrorCode::InvalidArgument, "grid is 0", {}}.to_string() == "grid is 0");
  // A line without a file would point nowhere.
  CHECK(Error{ErrorCode::InvalidArgument, "grid is 0", {"", 7, 0}}.to_string() == "grid is 0");
}

TEST_CASE("a result holds the value or the whole error") {
  const Result<double> good = halve(4);
  REQUIRE(good.has_value());
  CHECK(*good == 2);

  const Result<double> bad = halve(-1);
  REQUIRE_FALSE(bad.has_value());
  CHECK(bad.error().code == ErrorCode::InvalidArgument);
  CHECK(bad.error().position.line == 12);
  CHECK(bad.error().position.column == 3);
  CHECK(bad.error().to_string() == "lens.toml:12: x is negative: give 0 or more");
}

TEST_CASE("errors pass through a chain of steps untouched") {
  const auto chained = halve(-1).map([](double x) { return x + 1; });
  REQUIRE_FALSE(chained.has_value());
  CHECK(chained.error().position.file == "lens.toml");
}

TEST_CASE("degrees and radians are inverse and right at a quarter turn") {
  CHECK(rad_from_deg(90.0) == test::approx(1.5707963267948966).epsilon(1e-15));
  CHECK(deg_from_rad(rad_from_deg(12.5)) == test::approx(12.5).epsilon(1e-15));
  CHECK(um_from_nm(587.5618) == test::approx(0.5875618).epsilon(1e-15));
}

TEST_CASE("peak memory covers what was just used") {
  const std::uint64_t before = peak_memory_bytes();
  if (before == 0) {
    MESSAGE("SKIPPED: this system does not tell a process its peak memory");
    return;
  }
  const std::size_t size = std::size_t{64} << 20;
  std::vector<unsigned char> block(size);
  for (std::size_t i = 0; i < size; i += 1024) block[i] = static_cast<unsigned char>(i);
  CHECK(block[1024] == 0);
  CHECK(peak_memory_bytes() >= size);
  CHECK(peak_memory_bytes() >= before);
}

}  // namespace
}  // namespace contrejour
