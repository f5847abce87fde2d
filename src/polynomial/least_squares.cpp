// SPDX-License-Identifier: Apache-2.0
#include "polynomial/least_squares.h"

#include <cmath>

#include <Eigen/QR>

namespace contrejour::inline internal::polynomial {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct LeastSquares::State {
  Eigen::HouseholderQR<Eigen::MatrixXd> qr;
};

LeastSquares::LeastSquares(const Rows& matrix, double ridge) : state_(std::make_unique<State>()) {
  const auto rows = static_cast<Eigen::Index>(matrix.rows()), columns = static_cast<Eigen::Index>(matrix.columns);
  Eigen::MatrixXd all(rows + columns, columns);
  all.topRows(rows) = Eigen::Map<const Matrix>(matrix.values.data(), rows, columns);
  all.bottomRows(columns) = Eigen::MatrixXd::Identity(columns, columns) * ridge * std::sqrt(static_cast<double>(rows));
  state_->qr.compute(all);
}
LeastSquares::~LeastSquares() = default;
LeastSquares::LeastSquares(LeastSquares&&) noexcept = default;
LeastSquares& LeastSquares::operator=(LeastSquares&&) noexcept = default;

std::vector<double> LeastSquares::solve(std::span<const double> right) const {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(state_->qr.rows());
  const auto rows = static_cast<Eigen::Index>(right.size());
  all.head(rows) = Eigen::Map<const Eigen::VectorXd>(right.data(), rows);
  const Eigen::VectorXd unknowns = state_->qr.solve(all);
  return {unknowns.data(), unknowns.data() + unknowns.size()};
}

}  // namespace contrejour::inline internal::polynomial
