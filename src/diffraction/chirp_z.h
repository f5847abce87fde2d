// SPDX-License-Identifier: Apache-2.0
// A Fourier transform between any two regular grids, by three FFTs a row.
// Source: Bluestein 1970; Rabiner, Schafer & Rader 1969, "The chirp z-transform algorithm". Exact but for rounding.
#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/context.h"

namespace contrejour::inline internal {

// count points first, first + step, ...
struct RegularPoints {
  std::size_t count = 0;
  double first = 0, step = 1;
};

// count points a step apart, symmetric about 0.
[[nodiscard]] RegularPoints centred_points(std::size_t count, double step);

class ChirpZ {
 public:
  ChirpZ(const RegularPoints& from, const RegularPoints& to);

  // Transforms a square [row][column] of samples at from x from: the sums of samples times exp(-2 pi i (x u + y v)) at
  // to x to. Both dimensions are treated alike.
  [[nodiscard]] std::vector<std::complex<double>> transform_2d(std::span<const std::complex<double>> data,
                                                               const Context& context) const;

 private:
  using Row = std::vector<std::complex<double>>;
  // Transforms each row and puts it into a column of the result.
  [[nodiscard]] Row transform_transposed(std::span<const std::complex<double>> data, std::size_t rows,
                                         const Context& context) const;

  std::size_t from_, to_, length_;
  Row before_, kernel_, after_;
};

}  // namespace contrejour::inline internal
