// SPDX-License-Identifier: Apache-2.0
// Candan, Kutay & Ozaktas 2000, "The discrete fractional Fourier transform": the eigenvectors that the DFT shares with
// the discrete harmonic oscillator S (their eq. 17), by number of zero crossings, are multiplied by powers of -i.
// Differs: from hullin2011, which takes Ozaktas's fast algorithm: with that algorithm orders are additive to a few per
// cent only.
#include "contrejour/expert/fractional_fourier.h"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "base/tasks.h"

namespace contrejour {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Square = Eigen::Map<const RowMajor>;

constexpr int kTransformedAtOnce = 32;

// S restricted to even or odd vectors is tridiagonal. The columns of the result are its eigenvectors, by falling
// eigenvalue.
Eigen::MatrixXd eigenvectors_of(int side, bool even) {
  const int first = even ? 0 : 1;
  const int count = even ? side / 2 + 1 : (side + 1) / 2 - 1;
  Eigen::VectorXd diagonal(count), off_diagonal(std::max(count - 1, 0));
  for (int n = 0; n < count; ++n) diagonal[n] = 2.0 * std::cos(2.0 * std::numbers::pi * (n + first) / side);
  off_diagonal.setOnes();
  const bool odd_side = side % 2 != 0;
  if (odd_side && count > 0) diagonal[count - 1] += even ? 1.0 : -1.0;  // its neighbour is its own mirror image
  if (even && count > 1) {
    off_diagonal[0] = std::numbers::sqrt2;  // samples 0 and N / 2 have no mirror image
    if (!odd_side) off_diagonal[count - 2] = count == 2 ? 2.0 : std::numbers::sqrt2;
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, off_diagonal);
  return solver.eigenvectors().rowwise().reverse();
}

// out = left * square * left^T for a real left, by blocks of rows.
bool sandwich(const Eigen::Ref<const RowMajor>& left, std::vector<std::complex<double>>& square,
              const Context& context) {
  const auto side = static_cast<int>(left.rows());
  RowMajor real(side, side), imaginary(side, side);
  for (int pass = 0; pass < 2; ++pass) {  // each computes left * square, transposed
    for (int k = 0; k < side * side; ++k) {
      real.data()[k] = square[static_cast<std::size_t>(k)].real();
      imaginary.data()[k] = square[static_cast<std::size_t>(k)].imag();
    }
    const bool finished = parallel_for(
        static_cast<std::size_t>((side + kTransformedAtOnce - 1) / kTransformedAtOnce), context,
        [&](std::size_t block) {
          const int first = static_cast<int>(block) * kTransformedAtOnce,
                    count = std::min(kTransformedAtOnce, side - first);
          const RowMajor a = left.middleRows(first, count) * real, b = left.middleRows(first, count) * imaginary;
          for (int r = 0; r < count; ++r)
            for (int c = 0; c < side; ++c) square[static_cast<std::size_t>(c * side + first + r)] = {a(r, c), b(r, c)};
        });
    if (!finished) return false;
  }
  return true;
}

Context without_progress(Context context) {
  context.progress = {};
  return context;
}

}  // namespace

FractionalFourier::FractionalFourier(int side) : side_(side >= 1 && side <= kMaxSamples ? side : 0) {
  if (side_ == 0) return;
  const auto n = static_cast<std::size_t>(side);
  const int middle = side / 2;
  for (const bool even : {true, false}) {
    const Eigen::MatrixXd vectors = eigenvectors_of(side, even);
    for (int k = 0; k < vectors.cols(); ++k) {
      degree_.push_back(2 * k + (even ? 0 : 1));  // an even side has degree N in place of N - 1: 2 k gives it
      std::vector<double> row(n);
      for (int m = 0; m < vectors.rows(); ++m) {
        const int position = even ? m : m + 1, mirrored = (side - position) % side;
        const double value = position == mirrored ? vectors(m, k) : vectors(m, k) / std::numbers::sqrt2;
        row[static_cast<std::size_t>((position + middle) % side)] = value;
        row[static_cast<std::size_t>((mirrored + middle) % side)] = even || position == mirrored ? value : -value;
      }
      basis_.insert(basis_.end(), row.begin(), row.end());
    }
  }
}

std::vector<std::complex<double>> FractionalFourier::analyse(std::span<const std::complex<double>> square,
                                                             const Context& context) const {
  if (square.size() != basis_.size() || side_ == 0) return {};
  std::vector<std::complex<double>> result(square.begin(), square.end());
  if (!sandwich(Square(basis_.data(), side_, side_), result, without_progress(context))) return {};
  return result;
}

std::vector<std::complex<double>> FractionalFourier::at_order(std::span<const std::complex<double>> analysis,
                                                              double order, const Context& context) const {
  if (analysis.size() != basis_.size() || side_ == 0 || !std::isfinite(order)) return {};
  std::vector<std::complex<double>> result(analysis.begin(), analysis.end());
  // Candan 2000 eq. 21: exp(-i pi k a / 2) for degree k. Whole turns are removed before the sine.
  const auto n = static_cast<std::size_t>(side_);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n; ++c)
      result[r * n + c] *= std::polar(1.0, -0.5 * std::numbers::pi * std::fmod((degree_[r] + degree_[c]) * order, 4.0));
  const RowMajor synthesis = Square(basis_.data(), side_, side_).transpose();
  if (!sandwich(synthesis, result, without_progress(context))) return {};
  return result;
}

std::vector<std::complex<double>> FractionalFourier::transform(std::span<const std::complex<double>> square,
                                                               double order, const Context& context) const {
  return at_order(analyse(square, context), order, context);
}

double hullin_order(double lambda_nm, double f_number) { return 0.15 * (lambda_nm / 400.0) * (f_number / 18.0); }

}  // namespace contrejour
