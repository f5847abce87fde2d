// Rows of pixels, three floats each, as rows of pixels half as large, by vectors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace contrejour::area {

enum class Halving : std::uint8_t {
  // Averages of a polynomial of degree 4 stay averages of it (Donoho 1993, average interpolation), and each pixel keeps
  // its light. Where all pixels of a stencil are 0 or more, so are both halves: the one takes at most all of the light
  // (a limiter as Zhang & Shu 2010, "On maximum-principle-satisfying high order schemes").
  Interpolating,
  // A pixel's light is spread as the quadratic B-spline (Chaikin 1974): nothing overshoots, however much pixels differ,
  // and pictures come out smooth, and wider (smooth_variance).
  Smooth,
};

inline constexpr std::size_t kHalvesStencil = 2;  // pixels beside its own that a pixel's halves are found from

// What the variance of a picture of pixels' means grows by, in squares of a pixel, when Smooth halves it `times` times:
// 3 / 16 between the middles of halves, and what the means of pixels twice as wide had hidden.
[[nodiscard]] constexpr double smooth_variance(int times) {
  double variance = 0.0, square = 1.0;
  for (int k = 0; k < times; ++k, square *= 0.25) variance += 0.25 * square;
  return variance;
}

// Of a row and those kHalvesStencil above and below it, from the top down.
using RowsAround = std::array<const float*, 2 * kHalvesStencil + 1>;

// The two rows of half the height that the middle one covers, of `count` floats.
void halve_down(Halving how, const RowsAround& rows, std::size_t count, float* upper, float* lower);

// A row of `count` floats as one of twice as many pixels of half the width; those of its outermost kHalvesStencil
// pixels mean nothing.
void halve_across(Halving how, const float* row, std::size_t count, float* fine);

}  // namespace contrejour::area
