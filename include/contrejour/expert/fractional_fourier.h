// SPDX-License-Identifier: Apache-2.0
// The fractional Fourier transform of a square of samples: order 0 gives the samples, order 1 their spectrum, and
// orders between them the diffraction between an aperture and its far field. Squares of side N, the origin at sample N
// / 2 (rounded down) of each row and column; samples stand for points 1 / sqrt(N) apart. Accuracy: unitary, orders add,
// order 1 is the centred unitary DFT, all to 1e-9 (tests hold 1e-6). Thread-safety: const members may run at once.
// Source: Candan, Kutay & Ozaktas 2000; hullin2011 3.3.
#pragma once

#include <complex>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/export.h"

namespace contrejour {

class CONTREJOUR_API FractionalFourier {
 public:
  static constexpr int kMaxSamples = 4096;

  explicit FractionalFourier(int side);  // 1 to kMaxSamples, else side 0; computes the eigenvectors in O(N^3)

  [[nodiscard]] int side() const { return side_; }

  // Runs analyse() and at_order(). Empty when cancelled, for a square of another size, and for an order that is not
  // finite.
  [[nodiscard]] std::vector<std::complex<double>> transform(std::span<const std::complex<double>> square, double order,
                                                            const Context& context = {}) const;

  // Expands the square in eigenvectors once; at_order() then gives any number of orders. Empty in the same cases.
  [[nodiscard]] std::vector<std::complex<double>> analyse(std::span<const std::complex<double>> square,
                                                          const Context& context = {}) const;
  [[nodiscard]] std::vector<std::complex<double>> at_order(std::span<const std::complex<double>> analysis, double order,
                                                           const Context& context = {}) const;

 private:
  int side_;
  std::vector<double> basis_;  // [eigenvector * side + sample]
  std::vector<int> degree_;  // of the Hermite function that each eigenvector samples
};

// hullin2011 eq. 5: an empirical order whose ringing resembles a lens's.
[[nodiscard]] CONTREJOUR_API double hullin_order(double lambda_nm, double f_number);

}  // namespace contrejour
