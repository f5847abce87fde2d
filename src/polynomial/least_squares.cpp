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

std::vector<std::vector<double>> LeastSquares::solve_all(std::span<const std::vector<double>> right) const {
  const auto count = static_cast<Eigen::Index>(right.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(state_->qr.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::vector<double>& one = right[static_cast<std::size_t>(k)];
    all.col(k).head(static_cast<Eigen::Index>(one.size())) =
        Eigen::Map<const Eigen::VectorXd>(one.data(), static_cast<Eigen::Index>(one.size()));
  }
  const Eigen::MatrixXd unknowns = state_->qr.solve(all);
  std::vector<std::vector<double>> solutions;
  for (Eigen::Index k = 0; k < count; ++k)
    solutions.emplace_back(unknowns.col(k).data(), unknowns.col(k).data() + unknowns.rows());
  return solutions;
}

}  // namespace contrejour::inline internal::polynomial
