// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "base/tasks.h"
#include "polynomial/published/orthogonal_terms.h"
#include "polynomial/published/stopwatch.h"

namespace contrejour::inline internal::polynomial {
namespace {

using published::PursuitOptions;
using published::SparseFit;
using State = published::DenseFit::State;

// The terms that a search has chosen, and the curve of its errors.
struct Pursuit {
  const State& state;
  const Context& context;
  Stopwatch watch;
  std::vector<int> chosen;
  std::vector<published::CurvePoint> curve;

  void record(double error) {
    const double best = curve.empty() ? error : std::min(curve.back().best, error);
    curve.push_back({static_cast<int>(curve.size()) + 1, watch.seconds(), error, best});
  }
};

// The sums of a residual with all terms, and the sum of its squares.
struct Residual {
  Eigen::VectorXd with_terms;
  double squares = 0.0;
};

Residual residual_of(const State& state, std::span<const int> chosen, const Eigen::VectorXd& coefficients) {
  Residual residual{state.right, state.squares};
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const double c = coefficients[static_cast<Eigen::Index>(k)];
    residual.squares -= c * (state.right[chosen[k]] + residual.with_terms[chosen[k]]);
    residual.with_terms -= c * state.products.col(chosen[k]);
  }
  return residual;
}

// The sum of squares after adding a term with its dense coefficient.
double squares_with(const State& state, const Residual& residual, int term) {
  const double c = state.polynomial.terms[static_cast<std::size_t>(term)].coefficient;
  return residual.squares - 2.0 * c * residual.with_terms[term] + c * c * state.products(term, term);
}

int best_with_dense_coefficient(const State& state, const Residual& residual, std::span<const int> chosen) {
  int best = -1;
  double lowest = std::numeric_limits<double>::infinity();
  for (int term = 0; term < static_cast<int>(state.terms.size()); ++term) {
    const double squares = squares_with(state, residual, term);
    if (squares >= lowest || std::ranges::find(chosen, term) != chosen.end()) continue;
    lowest = squares;
    best = term;
  }
  return best;
}

// The chosen term in whose place a further one, with its dense coefficient, leaves the lowest error before a new fit.
std::size_t replaced_by(const State& state, const Residual& residual, std::span<const int> chosen,
                        const Eigen::VectorXd& coefficients, int term) {
  const double c = state.polynomial.terms[static_cast<std::size_t>(term)].coefficient;
  std::size_t best = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const int other = chosen[k];
    const double x = coefficients[static_cast<Eigen::Index>(k)];
    const double more =
        2.0 * x * (residual.with_terms[other] - c * state.products(other, term)) + x * x * state.products(other, other);
    if (more < lowest) lowest = more, best = k;
  }
  return best;
}

// sabatschus2022 3.8.
bool pursue_dense_coefficients(Pursuit& pursuit, const PursuitOptions& options) {
  const State& state = pursuit.state;
  Eigen::VectorXd coefficients;
  const int steps = options.replacement ? static_cast<int>(state.terms.size()) : options.terms;
  for (int step = 0; step < steps; ++step) {
    if (pursuit.context.cancelled()) return false;
    const Residual residual = residual_of(state, pursuit.chosen, coefficients);
    const int term = best_with_dense_coefficient(state, residual, pursuit.chosen);
    if (term < 0) return true;
    if (static_cast<int>(pursuit.chosen.size()) < options.terms)
      pursuit.chosen.push_back(term);
    else
      pursuit.chosen[replaced_by(state, residual, pursuit.chosen, coefficients, term)] = term;
    SubsetFit fit = fit_subset(state, pursuit.chosen);
    coefficients = std::move(fit.coefficients);
    pursuit.record(fit.error);
    if (pursuit.context.progress) pursuit.context.progress((step + 1.0) / steps);
  }
  return true;
}

// The places of the chosen terms, those first whose removal raises the error least: by x^2 over the inverse's diagonal.
std::vector<std::size_t> by_cost_of_removal(const State& state, std::span<const int> chosen) {
  const Eigen::Map<const Eigen::VectorXi> at(chosen.data(), static_cast<Eigen::Index>(chosen.size()));
  const Eigen::MatrixXd products = state.products(at, at);
  const Eigen::MatrixXd inverse = products.llt().solve(Eigen::MatrixXd::Identity(at.size(), at.size()));
  const Eigen::VectorXd coefficients = inverse * Eigen::VectorXd(state.right(at));
  const Eigen::VectorXd cost = coefficients.cwiseAbs2().cwiseQuotient(inverse.diagonal());
  std::vector<std::size_t> order(chosen.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return cost[static_cast<Eigen::Index>(k)]; });
  return order;
}

// Replaces the first chosen term, by the cost of its removal, for which another one lowers the error.
bool replace_one(Pursuit& pursuit, double& error) {
  constexpr double kLower = 1.0 - 1e-9;  // smaller gains are rounding, and could go on for ever
  for (const std::size_t place : by_cost_of_removal(pursuit.state, pursuit.chosen)) {
    if (pursuit.context.cancelled()) return false;
    OrthogonalTerms others(pursuit.state);
    for (std::size_t k = 0; k < pursuit.chosen.size(); ++k)
      if (k != place) others.choose(pursuit.chosen[k]);
    const int term = others.best();
    if (term < 0 || others.error_with(term) >= kLower * error) continue;
    pursuit.chosen[place] = term;
    error = others.error_with(term);
    return true;
  }
  return false;
}

bool pursue_error_reduction(Pursuit& pursuit, const PursuitOptions& options) {
  OrthogonalTerms terms(pursuit.state);
  while (static_cast<int>(pursuit.chosen.size()) < options.terms) {
    if (pursuit.context.cancelled()) return false;
    const int term = terms.best();
    if (term < 0) break;
    terms.choose(term);
    pursuit.chosen.push_back(term);
    pursuit.record(terms.error());
  }
  double error = terms.error();
  for (int step = 0; options.replacement && step < options.max_replacements; ++step) {
    if (!replace_one(pursuit, error)) break;
    pursuit.record(error);
  }
  return !pursuit.context.cancelled();
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour::published {

Result<SparseFit> matching_pursuit(const DenseFit& dense, const PursuitOptions& options, const Context& context) {
  const DenseFit::State& state = dense.state();
  if (options.terms < 1 || options.terms > static_cast<int>(state.terms.size()) || options.max_replacements < 0)
    return failure(ErrorCode::InvalidArgument, fmt::format("1 to {} terms can be chosen", state.terms.size()));
  polynomial::Pursuit pursuit{state, context, {}, {}, {}};
  const bool done = options.rating == PursuitOptions::Rating::DenseCoefficient
                        ? polynomial::pursue_dense_coefficients(pursuit, options)
                        : polynomial::pursue_error_reduction(pursuit, options);
  if (!done) return interrupted();
  SparseFit fit;
  fit.polynomial = polynomial::refined_subset(state, pursuit.chosen);
  fit.seconds = pursuit.watch.seconds();
  fit.error = rms_error(fit.polynomial, state.samples);
  fit.curve = std::move(pursuit.curve);
  return fit;
}

}  // namespace contrejour::published
