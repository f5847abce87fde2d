// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "polynomial/published/dense_state.h"
#include "polynomial/published/stopwatch.h"

namespace contrejour::published {
namespace {

using polynomial::Stopwatch;

Eigen::Index index_of(std::size_t n) { return static_cast<Eigen::Index>(n); }

Result<void> check_samples(const Samples& samples, int degree) {
  if (degree < 0 || degree > kLargestDegree)
    return failure(ErrorCode::InvalidArgument, fmt::format("a degree of 0 to {} is needed", kLargestDegree));
  if (samples.inputs.size() != samples.values.size())
    return failure(ErrorCode::InvalidArgument, "each sample needs one value");
  const std::size_t terms = terms_up_to(degree).size();
  if (samples.values.size() < terms)
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("{} terms need as many samples; there are {}", terms, samples.values.size()));
  for (std::size_t k = 0; k < samples.values.size(); ++k) {
    const Inputs& at = samples.inputs[k];
    const bool inside = std::ranges::all_of(at, [](double x) { return std::abs(x) <= 1.0; });
    if (!inside || !std::isfinite(samples.values[k]))
      return failure(ErrorCode::InvalidArgument, "samples need inputs from -1 to 1, and finite values");
  }
  return {};
}

Eigen::VectorXd values_of(const Samples& samples) {
  return Eigen::Map<const Eigen::VectorXd>(samples.values.data(), index_of(samples.values.size()));
}

}  // namespace

double evaluate(const Polynomial& polynomial, const Inputs& at) {
  std::array<std::array<double, kLargestDegree + 1>, 4> values;
  for (std::size_t axis = 0; axis < at.size(); ++axis)
    contrejour::polynomial::one_variable(polynomial.basis, kLargestDegree, at[axis], values[axis]);
  double sum = 0.0;
  for (const Term& term : polynomial.terms) {
    const Exponents& e = term.exponents;
    sum += term.coefficient * values[0][e[0]] * values[1][e[1]] * values[2][e[2]] * values[3][e[3]];
  }
  return sum;
}

double rms_error(const Polynomial& polynomial, const Samples& samples) {
  double sum = 0.0;
  for (std::size_t k = 0; k < samples.values.size(); ++k) {
    const double error = evaluate(polynomial, samples.inputs[k]) - samples.values[k];
    sum += error * error;
  }
  return samples.values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(samples.values.size()));
}

std::vector<Exponents> terms_up_to(int degree) {
  std::vector<Exponents> terms;
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j)
      for (int k = 0; i + j + k <= degree; ++k)
        for (int l = 0; i + j + k + l <= degree; ++l)
          terms.push_back({static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k),
                           static_cast<std::uint8_t>(l)});
  return terms;
}

const Polynomial& DenseFit::polynomial() const { return state_->polynomial; }
double DenseFit::error() const { return state_->error; }
double DenseFit::seconds() const { return state_->seconds; }

Result<DenseFit> DenseFit::fit(const Samples& samples, int degree, Basis basis) {
  if (const auto good = check_samples(samples, degree); !good) return tl::unexpected(good.error());
  const Stopwatch watch;
  auto state = std::make_shared<State>(
      State{samples, polynomial::TermTables(basis, degree, samples.inputs), terms_up_to(degree), {basis, {}}, {}, {}});
  const Eigen::Index rows = index_of(samples.values.size()), columns = index_of(state->terms.size());
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index k = 0; k < columns; ++k)
    matrix.col(k) = state->tables.column(state->terms[static_cast<std::size_t>(k)], 0, rows).matrix();
  const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(matrix);  // in place
  const Eigen::VectorXd values = values_of(samples);
  const Eigen::VectorXd turned = qr.householderQ().adjoint() * values;
  const auto triangle = qr.matrixQR().topRows(columns).template triangularView<Eigen::Upper>();
  const Eigen::VectorXd coefficients = triangle.solve(turned.head(columns));
  for (Eigen::Index k = 0; k < columns; ++k)
    state->polynomial.terms.push_back({state->terms[static_cast<std::size_t>(k)], coefficients[k]});
  const Eigen::MatrixXd r = triangle;
  state->products = r.transpose() * r;
  state->right = r.transpose() * turned.head(columns);
  state->squares = values.squaredNorm();
  state->error = std::sqrt(turned.tail(rows - columns).squaredNorm() / static_cast<double>(rows));
  state->seconds = watch.seconds();
  return DenseFit(std::move(state));
}

}  // namespace contrejour::published

namespace contrejour::inline internal::polynomial {

using State = published::DenseFit::State;

namespace {

double error_of(const State& state, double sum_of_squares) {
  return std::sqrt(std::max(sum_of_squares, 0.0) / static_cast<double>(state.samples.values.size()));
}

}  // namespace

SubsetFit fit_subset(const State& state, std::span<const int> subset) {
  const Eigen::Map<const Eigen::VectorXi> chosen(subset.data(), static_cast<Eigen::Index>(subset.size()));
  const Eigen::MatrixXd products = state.products(chosen, chosen);
  const Eigen::VectorXd right = state.right(chosen);
  const Eigen::LLT<Eigen::MatrixXd> factors(products);
  if (factors.info() != Eigen::Success) return {{}, std::numeric_limits<double>::infinity()};
  SubsetFit fit;
  fit.coefficients = factors.solve(right);
  fit.error = error_of(state, state.squares - right.dot(fit.coefficients));
  return fit;
}

double subset_error(const State& state, std::span<const int> subset, const Eigen::VectorXd& coefficients) {
  const Eigen::Map<const Eigen::VectorXi> chosen(subset.data(), static_cast<Eigen::Index>(subset.size()));
  const Eigen::MatrixXd products = state.products(chosen, chosen);
  const Eigen::VectorXd right = state.right(chosen);
  return error_of(state, state.squares - 2.0 * right.dot(coefficients) + coefficients.dot(products * coefficients));
}

Eigen::VectorXd dense_coefficients(const State& state, std::span<const int> subset) {
  Eigen::VectorXd coefficients(static_cast<Eigen::Index>(subset.size()));
  for (std::size_t k = 0; k < subset.size(); ++k)
    coefficients[static_cast<Eigen::Index>(k)] =
        state.polynomial.terms[static_cast<std::size_t>(subset[k])].coefficient;
  return coefficients;
}

published::Polynomial subset_polynomial(const State& state, std::span<const int> subset,
                                        const Eigen::VectorXd& coefficients) {
  published::Polynomial sparse{state.polynomial.basis, {}};
  for (std::size_t k = 0; k < subset.size(); ++k)
    sparse.terms.push_back(
        {state.terms[static_cast<std::size_t>(subset[k])], coefficients[static_cast<Eigen::Index>(k)]});
  return sparse;
}

published::Polynomial refined_subset(const State& state, std::span<const int> subset) {
  const Eigen::Index rows = state.tables.rows(), columns = static_cast<Eigen::Index>(subset.size());
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const auto term = static_cast<std::size_t>(subset[static_cast<std::size_t>(k)]);
    matrix.col(k) = state.tables.column(state.terms[term], 0, rows).matrix();
  }
  const Eigen::Map<const Eigen::VectorXd> values(state.samples.values.data(), rows);
  return subset_polynomial(state, subset, matrix.householderQr().solve(values));
}

}  // namespace contrejour::inline internal::polynomial
