// SPDX-License-Identifier: Apache-2.0
// Discs of a known lens against its traced ghosts.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/learn_lens.h"
#include "support/approx.h"

using namespace contrejour;

TEST_CASE("discs of a lens: the Tessar's ghost 1-8, whose disc no other covers") {
  const LensState lens = *configure_lens(*find_lens("tessar"), {});
  const double largest_rad = 0.2;
  const auto discs = discs_of_lens(lens, largest_rad, 8);
  REQUIRE_MESSAGE(discs.has_value(), discs.error().to_string());
  CHECK(discs->size() <= 8);
  const double speed = -1.09;  // as the exact renderer's pictures have it
  const auto at = std::ranges::find_if(*discs, [&](const FoundGhost& d) { return std::abs(d.speed - speed) < 0.02; });
  REQUIRE(at != discs->end());
  // Its body, of which most of its footprint is only a skirt: as a picture of 640 pixels shows it, an RMS height
  // of 19.6.
  const double focal_px = first_order(lens, 550.0).focal_length_mm / frame_on_sensor(lens, 640, 424).pixel_pitch_mm;
  const double s = 0.45 * std::tan(largest_rad);
  CHECK(at->radius * (1.0 + at->growth * s * s) * focal_px == test::approx(2.0 * 19.6).epsilon(0.1));
  CHECK(at->first < at->last);
}

TEST_CASE("discs of a lens: angles that no sweep has are refused") {
  const LensState lens = *configure_lens(*find_lens("tessar"), {});
  CHECK(!discs_of_lens(lens, 0.0, 8));
  CHECK(!discs_of_lens(lens, 2.0, 8));
  CHECK(!discs_of_lens(lens, std::nan(""), 8));
  CHECK(!discs_of_lens(lens, 0.2, 0));
}
