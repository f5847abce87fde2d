// SPDX-License-Identifier: Apache-2.0
// Packs irradiance in 16 bits, so that two neighbours in a table are one word. The code is a positive float with 4 bits
// of exponent and 12 of mantissa: a shift and a sum turn it into a 32-bit float, from which none() is subtracted.
// Accuracy: 2^-13 of the light plus none(), which is at most 2^-15 of the largest value. 0 is exact. Thread-safety: a
// value.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace contrejour::inline internal::raster {

class PackedIrradiance {
 public:
  static constexpr int kShift = 11;  // from the code's bits to their position in a float

  // For values from 0 to `largest`.
  explicit PackedIrradiance(float largest = 0.0F) {
    const std::int32_t exponent = std::bit_cast<std::int32_t>(largest * kHeadroom) >> kMantissa;
    lowest_ = std::max(exponent - 15, 1) << kMantissa;
  }

  [[nodiscard]] static PackedIrradiance of_lowest(std::int32_t lowest) {
    PackedIrradiance light;
    light.lowest_ = lowest;
    return light;
  }

  [[nodiscard]] std::uint16_t coded(float light) const {
    const std::int32_t bits = std::bit_cast<std::int32_t>(std::max(light, 0.0F) + none());
    return static_cast<std::uint16_t>(std::min((bits - lowest_ + kHalfStep) >> kShift, 0xFFFF));
  }
  [[nodiscard]] float light(std::uint16_t coded) const {
    return std::bit_cast<float>((static_cast<std::int32_t>(coded) << kShift) + lowest_) - none();
  }
  [[nodiscard]] std::int32_t lowest() const { return lowest_; }  // the bits of the float that 0 represents
  [[nodiscard]] float none() const { return std::bit_cast<float>(lowest_); }

 private:
  static constexpr int kMantissa = 23;  // of a float, bits
  static constexpr float kHeadroom = 1.0005F;  // so that `none` and rounding up do not overflow
  static constexpr std::int32_t kHalfStep = 1 << (kShift - 1);
  std::int32_t lowest_;
};

}  // namespace contrejour::inline internal::raster
