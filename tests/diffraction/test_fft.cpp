// SPDX-License-Identifier: Apache-2.0
// The FFT wrapper and the chirp transform against plain sums.
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "diffraction/chirp_z.h"
#include "diffraction/fft.h"

using namespace contrejour;

namespace {

using Complex = std::complex<double>;

std::vector<Complex> some_data(std::size_t count) {
  std::vector<Complex> data(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto x = static_cast<double>(k);
    data[k] = {std::sin(12.9898 * x), std::cos(78.233 * x * x)};
  }
  return data;
}

Complex plain_sum(const std::vector<Complex>& data, FftShape shape, double u, double v) {
  Complex sum = 0.0;
  for (std::size_t r = 0; r < shape.rows; ++r)
    for (std::size_t c = 0; c < shape.columns; ++c)
      sum += data[r * shape.columns + c] *
             std::polar(1.0, -2.0 * std::numbers::pi * (static_cast<double>(c) * u + static_cast<double>(r) * v));
  return sum;
}

}  // namespace

TEST_CASE("2-D transforms are the plain sums, in double and in float, and come back") {
  const FftShape shape{12, 35};
  const std::vector<Complex> data = some_data(12 * 35);
  std::vector<Complex> spectrum = data;
  REQUIRE(fft_2d<double>(spectrum, shape, FftDirection::Forward, {}));
  std::vector<std::complex<float>> single(data.begin(), data.end());
  REQUIRE(fft_2d<float>(single, shape, FftDirection::Forward, {}));
  for (std::size_t k = 0; k < spectrum.size(); k += 17) {
    const Complex expected = plain_sum(data, shape, static_cast<double>(k % 35) / 35, static_cast<double>(k / 35) / 12);
    CHECK(std::abs(spectrum[k] - expected) < 1e-10);
    CHECK(std::abs(Complex(single[k]) - expected) < 1e-3);
  }
  REQUIRE(fft_2d<double>(spectrum, shape, FftDirection::Backward, {}));
  for (std::size_t k = 0; k < data.size(); ++k) CHECK(std::abs(spectrum[k] / 420.0 - data[k]) < 1e-13);
}

TEST_CASE("the real transform is the padded plain sum") {
  std::vector<float> data(5 * 7);
  for (std::size_t k = 0; k < data.size(); ++k) data[k] = std::sin(static_cast<float>(k * k));
  const auto spectrum = fft_2d_real(data, {5, 7}, 16, 6, {});
  const std::vector<Complex> wide(data.begin(), data.end());
  for (std::size_t row = 0; row < 16; ++row)
    for (std::size_t column = 0; column < 6; ++column)
      CHECK(std::abs(Complex(spectrum[row * 6 + column]) -
                     plain_sum(wide, {5, 7}, static_cast<double>(column) / 16, static_cast<double>(row) / 16)) < 1e-5);
}

TEST_CASE("the same bits for any number of threads; cancelling is told") {
  const std::vector<Complex> data = some_data(64 * 48);
  std::vector<Complex> one = data, seven = data;
  fft_2d<double>(one, {64, 48}, FftDirection::Forward, {.threads = 1});
  fft_2d<double>(seven, {64, 48}, FftDirection::Forward, {.threads = 7});
  CHECK(one == seven);
  const std::atomic<bool> stop = true;
  CHECK_FALSE(fft_2d<double>(one, {64, 48}, FftDirection::Forward, {.cancel = &stop}));
}

TEST_CASE("the chirp transform is the plain sum at the points asked for") {
  constexpr std::size_t kSide = 9;
  const std::vector<Complex> data = some_data(kSide * kSide);
  const RegularPoints from = centred_points(kSide, 0.1), to{5, -1.7, 0.83};
  const std::vector<Complex> result = ChirpZ(from, to).transform_2d(data, {});
  for (std::size_t row = 0; row < to.count; ++row) {
    for (std::size_t column = 0; column < to.count; ++column) {
      const double u = to.first + to.step * static_cast<double>(column),
                   v = to.first + to.step * static_cast<double>(row);
      const Complex shift = std::polar(1.0, -2.0 * std::numbers::pi * from.first * (u + v));
      const Complex expected = shift * plain_sum(data, {kSide, kSide}, u * from.step, v * from.step);
      CHECK(std::abs(result[row * to.count + column] - expected) < 1e-11);
    }
  }
}
