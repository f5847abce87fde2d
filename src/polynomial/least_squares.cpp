// SPDX-License-Identifier: Apache-2.0
#include "polynomial/least_squares.h"

#include <Eigen/QR>

namespace contrejour::inline internal::polynomial {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct LeastSquares::State {
  Eigen::HouseholderQR<Eigen::MatrixXd> qr;
};

LeastSquares::LeastSquares(const Rows& matrix) : state_(std::make_unique<State>()) {
  state_->qr.compute(Eigen::Map<const Matrix>(matrix.values.data(), static_cast<Eigen::Index>(matrix.rows()),
                                              static_cast<Eigen::Index>(matrix.columns)));
}
LeastSquares::~LeastSquares() = default;
LeastSquares::LeastSquares(LeastSquares&&) noexcept = default;
LeastSquares& LeastSquares::operator=(LeastSquares&&) noexcept = default;

std::vector<double> LeastSquares::solve(std::span<const double> right) const {
  const Eigen::VectorXd unknowns =
      state_->qr.solve(Eigen::Map<const Eigen::VectorXd>(right.data(), static_cast<Eigen::Index>(right.size())));
  return {unknowns.data(), unknowns.data() + unknowns.size()};
}

}  // namespace contrejour::inline internal::polynomial
