// SPDX-License-Identifier: Apache-2.0
// A small correct lens as text, and edits of it: each test breaks one thing.
#pragma once

#include <string>

#include <doctest/doctest.h>

namespace contrejour::test {

// Tests rely on line numbers: surfaces 1 to 5 are on lines 6 to 10.
inline const std::string kSampleLens = R"(name = "Sample"
source = "none"
f_number = 4.0
sensor_mm = [36, 24]
surfaces = [
  { radius_mm = 50.0, thickness_mm = 5.0, semi_diameter_mm = 10.0, glass = "BK7" },
  { radius_mm = -60.0, thickness_mm = 3.0, semi_diameter_mm = 10.0 },
  { stop = true, thickness_mm = 2.0, semi_diameter_mm = 6.0 },
  { radius_mm = inf, thickness_mm = 4.0, semi_diameter_mm = 9.0, glass = "SF2" },
  { radius_mm = 70.0, semi_diameter_mm = 9.0 },
]
[stated]
focal_length_mm = 60.0
[glass]
BK7 = { n_d = 1.5168, v_d = 64.17 }
SF2 = { n_d = 1.64769, v_d = 33.85 }
)";

// The sample with one piece of text replaced; the piece must be there.
inline std::string edited(const std::string& from, const std::string& to, std::string text = kSampleLens) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

inline const std::string kZoomRows = R"(zoom = [
  { focal_length_mm = 50, thickness_mm = { 2 = 3.0 } },
  { focal_length_mm = 60, thickness_mm = { 2 = 4.0 } },
]
[stated])";

// The sample as a zoom: its positions are on lines 13 and 14.
inline std::string zoom_sample() { return edited("[stated]", kZoomRows); }

}  // namespace contrejour::test
