// SPDX-License-Identifier: Apache-2.0
// Files of polynomials: written and read as the same values, and refused where they are damaged.
#include <cmath>
#include <random>

#include <doctest/doctest.h>

#include "contrejour/expert/polynomial.h"

using namespace contrejour;

namespace {

const std::string& triplet_file() {
  static const std::string bytes = [] {
    const auto lens = configure_lens(*find_lens("cooke-triplet"));
    REQUIRE(lens.has_value());
    // Tolerances that fits of a low order reach: zones that are traced have no polynomials.
    const auto fit = fit_polynomials(*lens, {.position_px = 1e3,
                                             .edge = 10.0,
                                             .transmittance = 10.0,
                                             .max_order = 7,
                                             .max_halvings = 0,
                                             .scope = GhostScope::OneSideOfStop});
    REQUIRE(fit.has_value());
    return write_polynomials(*fit);
  }();
  return bytes;
}

std::string error_of(std::string_view bytes) {
  const auto read = read_polynomials(bytes, "a.poly");
  return read ? std::string() : read.error().to_string();
}

}  // namespace

TEST_CASE("a file is read as the values that were written") {
  const auto read = read_polynomials(triplet_file(), "a.poly");
  REQUIRE(read.has_value());
  CHECK(write_polynomials(*read) == triplet_file());
  CHECK(read->ghosts.size() == 7);
  CHECK(read->lens.find("triplet") != std::string::npos);
}

// Files of before the pupil's end have three numbers for a pupil's coordinates.
TEST_CASE("a file keeps the pupil's end of each zone, and may have none") {
  auto fit = *read_polynomials(triplet_file(), "a.poly");
  const auto fitted = [](const PolynomialZone& zone) { return zone.state == PolynomialZone::State::Fitted; };
  int ends = 0;
  for (GhostPolynomials& ghost : fit.ghosts)
    for (PolynomialZone& zone : ghost.zones)
      if (fitted(zone)) ends += zone.pupil_end > 0.1 && zone.pupil_end < 2.0 ? 1 : 0, zone.pupil_end = 0.0;
  CHECK(ends >= 3);
  const auto without = read_polynomials(write_polynomials(fit), "a.poly");
  REQUIRE(without.has_value());
  for (const GhostPolynomials& ghost : without->ghosts)
    for (const PolynomialZone& zone : ghost.zones) CHECK(zone.pupil_end == 0.0);
}

TEST_CASE("errors name the file and the remedy") {
  CHECK(error_of("").starts_with("a.poly: "));
  CHECK(error_of("not CBOR at all").starts_with("a.poly: "));
  CHECK(error_of("\xa1\x61"
                 "a\x01")
            .find("polynomial fit") != std::string::npos);  // a map of another kind
  CHECK(read_polynomial_file("no-such-file.poly").error().code == ErrorCode::Io);
}

TEST_CASE("every shortened file is refused") {
  const std::string& whole = triplet_file();
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 500)
    CHECK(!read_polynomials(std::string_view(whole).substr(0, size), "a.poly").has_value());
}

TEST_CASE("damaged files are refused or evaluate to numbers") {
  std::mt19937 random(7);
  for (int k = 0; k < 2000; ++k) {
    std::string bytes = triplet_file();
    for (int flips = 0; flips < 3; ++flips) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    const auto read = read_polynomials(bytes, "a.poly");
    if (!read) continue;
    for (const GhostPolynomials& ghost : read->ghosts) {
      for (const PolynomialZone& zone : ghost.zones) {
        if (zone.state != PolynomialZone::State::Fitted) continue;
        const PolynomialRay ray = evaluate(*read, zone, zone.field_high, {0.1, 0.2}, 550.0);
        CHECK(!std::isnan(ray.transmittance));
      }
    }
  }
}
