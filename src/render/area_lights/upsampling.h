// SPDX-License-Identifier: Apache-2.0
// Upsampling of rows of pixels, three floats each, to pixels half as large, vectorised.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace contrejour::inline internal::area {

enum class Upsampling : std::uint8_t {
  // Average interpolation (Donoho 1993): averages of a polynomial of degree 4 become averages of the same polynomial,
  // and each pixel keeps its flux. If all pixels of a stencil are 0 or more, so are both halves: a limiter gives each
  // of them at most all of the flux (as in Zhang & Shu 2010, "On maximum-principle-satisfying high order schemes").
  Interpolating,
  // Spreads a pixel's flux as the quadratic B-spline (Chaikin 1974): nothing overshoots, however much pixels differ,
  // and images become smooth and wider (smooth_variance).
  Smooth,
};

inline constexpr std::size_t kUpsamplingStencil = 2;  // neighbours on each side that a pixel's halves depend on

// The increase of an image's variance, in squares of a pixel, by `times` upsamplings with Smooth: 3 / 16 between the
// centres of halves, and the variance within pixels twice as wide, which their means had hidden.
[[nodiscard]] constexpr double smooth_variance(int times) {
  double variance = 0.0, square = 1.0;
  for (int k = 0; k < times; ++k, square *= 0.25) variance += 0.25 * square;
  return variance;
}

// A row and the kUpsamplingStencil rows above and below it, from the top down.
using RowsAround = std::array<const float*, 2 * kUpsamplingStencil + 1>;

// Computes the two rows of half the height that the middle row covers. count: floats of a row.
void halve_down(Upsampling how, const RowsAround& rows, std::size_t count, float* upper, float* lower);

// Upsamples a row of `count` floats to twice as many pixels of half the width. Results for the outermost
// kUpsamplingStencil pixels are undefined.
void upsample_across(Upsampling how, const float* row, std::size_t count, float* fine);

}  // namespace contrejour::inline internal::area
