// SPDX-License-Identifier: Apache-2.0
// The defining properties of the fractional Fourier transform, each to 1e-6, for even and odd sides; and Hermite-Gauss
// functions.
#include <cmath>
#include <complex>
#include <vector>

#include <doctest/doctest.h>

#include "base/scalar.h"
#include "contrejour/expert/fractional_fourier.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

using Square = std::vector<std::complex<double>>;

Square some_square(int side) {
  Square square(static_cast<std::size_t>(side * side));
  for (std::size_t k = 0; k < square.size(); ++k) {
    const auto x = static_cast<double>(k);
    square[k] = {std::sin(12.9898 * x), std::cos(0.3 * x * x)};
  }
  return square;
}

double largest_difference(const Square& a, const Square& b) {
  double worst = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
  return worst;
}

double energy(const Square& a) {
  double sum = 0.0;
  for (const auto& v : a) sum += std::norm(v);
  return sum;
}

// The unitary DFT about the middle sample, by plain sums.
Square centred_dft(const Square& a, int side) {
  Square rows(a.size()), result(a.size());
  const int m = side / 2;
  const auto at = [side](int r, int c) { return static_cast<std::size_t>(r * side + c); };
  for (int r = 0; r < side; ++r)
    for (int u = 0; u < side; ++u)
      for (int c = 0; c < side; ++c)
        rows[at(r, u)] +=
            a[at(r, c)] * std::polar(1.0 / std::sqrt(side), -2.0 * kPi * ((u - m) * (c - m) % side) / side);
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u)
      for (int r = 0; r < side; ++r)
        result[at(v, u)] +=
            rows[at(r, u)] * std::polar(1.0 / std::sqrt(side), -2.0 * kPi * ((v - m) * (r - m) % side) / side);
  return result;
}

}  // namespace

TEST_CASE("orders 0, 1 and 2: identity, the centred DFT, the flip; orders add; energy stays") {
  for (const int side : {1, 2, 3, 8, 33, 64, 127}) {
    const FractionalFourier fourier(side);
    const Square square = some_square(side);
    CHECK(largest_difference(fourier.transform(square, 0.0), square) < 1e-6);
    CHECK(largest_difference(fourier.transform(square, 1.0), centred_dft(square, side)) < 1e-6);
    CHECK(largest_difference(fourier.transform(square, 4.0), square) < 1e-6);
    Square flipped(square.size());
    const int m = side / 2;
    for (int r = 0; r < side; ++r)
      for (int c = 0; c < side; ++c)
        flipped[static_cast<std::size_t>((2 * m - r + side) % side * side + (2 * m - c + side) % side)] =
            square[static_cast<std::size_t>(r * side + c)];
    CHECK(largest_difference(fourier.transform(square, 2.0), flipped) < 1e-6);
    const Square part = fourier.transform(square, 0.37);
    CHECK(largest_difference(fourier.transform(part, 0.63), fourier.transform(square, 1.0)) < 1e-6);
    CHECK(largest_difference(fourier.transform(fourier.transform(square, -0.8), 0.8), square) < 1e-6);
    CHECK(energy(part) == test::approx(energy(square)).epsilon(1e-9));
  }
}

TEST_CASE("a Gaussian off the axis turns in phase space as the continuous transform has it") {
  constexpr int kSide = 128;
  const FractionalFourier fourier(kSide);
  const auto x_of = [](int i) { return (i - kSide / 2) / std::sqrt(static_cast<double>(kSide)); };
  Square square(kSide * kSide);
  for (int r = 0; r < kSide; ++r)
    for (int c = 0; c < kSide; ++c)
      square[static_cast<std::size_t>(r * kSide + c)] =
          std::exp(-kPi * (std::pow(x_of(c) - 1.0, 2) + x_of(r) * x_of(r)));
  for (const double order : {0.2, 0.5, 0.9}) {
    // Ozaktas 2001: its middle moves to cos(a pi / 2), its width is unchanged. S is the oscillator only up to 1 / N.
    const Square turned = fourier.transform(square, order);
    for (int c = 0; c < kSide; ++c) {
      const double expected = std::exp(-kPi * std::pow(x_of(c) - std::cos(0.5 * kPi * order), 2));
      CHECK(std::abs(turned[static_cast<std::size_t>(kSide / 2 * kSide + c)]) ==
            test::approx(expected).epsilon(0.015).scale(1.0));
    }
  }
}

TEST_CASE("orders of one analysis are those of separate transforms; cancelling empties; hullin2011 eq. 5") {
  const FractionalFourier fourier(40);
  const Square square = some_square(40), analysis = fourier.analyse(square);
  CHECK(largest_difference(fourier.at_order(analysis, 0.15), fourier.transform(square, 0.15)) < 1e-12);
  CHECK(fourier.transform(square, 0.3, {.threads = 1}) == fourier.transform(square, 0.3, {.threads = 5}));
  const std::atomic<bool> stop = true;
  CHECK(fourier.transform(square, 0.3, {.cancel = &stop}).empty());
  CHECK(hullin_order(400.0, 18.0) == test::approx(0.15));
  CHECK(hullin_order(600.0, 9.0) == test::approx(0.1125));
}
