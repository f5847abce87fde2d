// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/zone_errors.h"

#include <cmath>
#include <limits>

#include <Eigen/QR>

namespace contrejour::inline internal::polynomial {
namespace {

// A column whose part that is independent of the others is smaller than this depends on them.
constexpr double kDependentColumn = 1e-9;

}  // namespace

ZoneErrors::ZoneErrors(std::span<const published::ZoneSamples> zones, int largest_exponent) {
  for (const published::ZoneSamples& zone : zones) {
    tables_.emplace_back(published::Basis::Monomials, largest_exponent, zone.inputs);
    values_.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(zone.values.data(), static_cast<Eigen::Index>(zone.values.size())));
  }
}

ZoneErrors::Fitted ZoneErrors::fit(std::size_t zone, std::span<const published::Exponents> terms) const {
  const TermTables& tables = tables_[zone];
  Eigen::MatrixXd matrix(tables.rows(), static_cast<Eigen::Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k)
    matrix.col(static_cast<Eigen::Index>(k)) = tables.column(terms[k], 0, tables.rows()).matrix();
  const Eigen::VectorXd norms = matrix.colwise().norm();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  for (Eigen::Index k = 0; k < matrix.cols(); ++k)
    if (!(std::abs(qr.matrixQR()(k, k)) > kDependentColumn * norms[k]))
      return {{}, std::numeric_limits<double>::infinity()};
  Fitted fitted{qr.solve(values_[zone]), 0.0};
  const double squares = (values_[zone] - matrix * fitted.coefficients).squaredNorm();
  fitted.error = std::sqrt(squares / static_cast<double>(tables.rows()));
  return fitted;
}

double ZoneErrors::error(std::span<const published::Exponents> terms) const {
  double sum = 0.0;
  for (std::size_t zone = 0; zone < zones(); ++zone) {
    const double error = fit(zone, terms).error;
    sum += error * error;
  }
  return std::sqrt(sum / static_cast<double>(zones()));
}

}  // namespace contrejour::inline internal::polynomial
