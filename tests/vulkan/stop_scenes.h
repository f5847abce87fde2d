// SPDX-License-Identifier: Apache-2.0
// Lenses with dirt, or with a picture as the iris, for tests of devices.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "device_frames.h"

namespace contrejour::test {

inline LensState dirty_lens(const Dirt& dirt, double f_number, const std::string& name = "heliar") {
  LensState lens = lens_of(name, 7, f_number);
  lens.dirt = dirt;
  return lens;
}

inline Dirt dust_and_scratches(DirtPlane plane) {
  Dirt dirt;
  dirt.dust_per_cm2 = 40.0;
  dirt.dust_mm = 0.3;
  dirt.scratches_per_cm2 = 10.0;
  dirt.scratch_width_mm = 0.05;
  dirt.plane = plane;
  return dirt;
}

// Dark bars on white.
inline std::shared_ptr<const DirtPicture> dirt_bars() {
  constexpr int kSide = 24;
  std::vector<float> level;
  for (int k = 0; k < kSide * kSide; ++k) level.push_back(k % kSide % 6 < 2 ? 0.25F : 1.0F);
  const auto picture = DirtPicture::from_levels(level, kSide, kSide);
  REQUIRE(picture.has_value());
  return *picture;
}

// A star with a hole; half_tones: with waves of light and dark.
inline LensState star_lens(bool half_tones, double f_number) {
  constexpr int kSide = 128;
  std::vector<float> level;
  for (int k = 0; k < kSide * kSide; ++k) {
    const double x = 2.0 * (k % kSide + 0.5) / kSide - 1.0, y = 2.0 * (k / kSide + 0.5) / kSide - 1.0;
    const bool open =
        std::hypot(x, y) < 0.6 + 0.3 * std::cos(5.0 * std::atan2(y, x)) && std::hypot(x - 0.1, y - 0.1) > 0.15;
    const double tone = half_tones ? 0.65 + 0.35 * std::sin(9.0 * x) * std::cos(7.0 * y) : 1.0;
    level.push_back(open ? static_cast<float>(tone) : 0.0F);
  }
  const auto field = IrisField::from_levels(level, kSide, kSide);
  REQUIRE(field.has_value());
  REQUIRE((*field)->has_half_tones() == half_tones);
  LensState lens = lens_of("heliar", 0, f_number);
  lens.iris.field = *field;
  lens.iris.rotation_rad = 0.3;
  return lens;
}

}  // namespace contrejour::test
