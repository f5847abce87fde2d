// SPDX-License-Identifier: Apache-2.0
// sabatschus2022 3.9: simulated annealing over the choices of a number of terms.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "base/tasks.h"
#include "polynomial/published/dense_state.h"
#include "polynomial/published/seeded_random.h"
#include "polynomial/published/stopwatch.h"

namespace contrejour::inline internal::polynomial {
namespace {

using published::AnnealingOptions;
using State = published::DenseFit::State;

constexpr int kCurvePoints = 400;

class Annealing {
 public:
  Annealing(const State& state, const AnnealingOptions& options)
      : state_(state), options_(options), random_(options.seed), terms_(state.terms.size()) {
    std::iota(terms_.begin(), terms_.end(), 0);
    for (std::size_t k = 0; k < chosen_count(); ++k) std::swap(terms_[k], terms_[k + random_.below(terms_.size() - k)]);
    error_ = rate(0, false);
    best_ = error_;
    best_terms_.assign(chosen().begin(), chosen().end());
  }

  void step(int iteration) {
    const double temperature = static_cast<double>(options_.iterations - iteration) / options_.iterations;
    const Eigen::Index first = random_window();
    exchange(temperature);
    const double error = rate(first, options_.fit);
    if (error < error_ || random_.unit() < std::exp(-(error - error_) * options_.factor / temperature))
      error_ = error;
    else
      undo();
    if (error_ < best_) {
      best_ = error_;
      best_terms_.assign(chosen().begin(), chosen().end());
    }
  }

  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] double best() const { return best_; }
  [[nodiscard]] std::span<const int> result() const { return options_.keep_best ? best_terms_ : chosen(); }

 private:
  [[nodiscard]] std::size_t chosen_count() const { return static_cast<std::size_t>(options_.terms); }
  [[nodiscard]] std::span<const int> chosen() const { return std::span(terms_).first(chosen_count()); }

  [[nodiscard]] Eigen::Index random_window() {
    if (options_.samples == 0) return 0;
    return static_cast<Eigen::Index>(
        random_.below(static_cast<std::size_t>(state_.tables.rows() - options_.samples) + 1));
  }

  // Exchanges terms that are chosen, each at most once, with others.
  void exchange(double temperature) {
    const double wanted = std::pow(temperature, options_.power) * options_.terms;
    const std::size_t count = std::clamp<std::size_t>(static_cast<std::size_t>(wanted), 1, chosen_count());
    places_.resize(chosen_count());
    std::iota(places_.begin(), places_.end(), std::size_t{0});
    exchanged_.clear();
    for (std::size_t k = 0; k < count; ++k) {
      std::swap(places_[k], places_[k + random_.below(places_.size() - k)]);
      const std::size_t other = chosen_count() + random_.below(terms_.size() - chosen_count());
      std::swap(terms_[places_[k]], terms_[other]);
      exchanged_.emplace_back(places_[k], other);
    }
  }

  void undo() {
    for (std::size_t k = exchanged_.size(); k-- > 0;)
      std::swap(terms_[exchanged_[k].first], terms_[exchanged_[k].second]);
  }

  // The error of the chosen terms over the samples of a step.
  [[nodiscard]] double rate(Eigen::Index first, bool fit) const {
    if (options_.samples == 0)
      return fit ? fit_subset(state_, chosen()).error
                 : subset_error(state_, chosen(), dense_coefficients(state_, chosen()));
    const Eigen::Index rows = options_.samples, columns = options_.terms;
    Eigen::MatrixXd matrix(rows, columns);
    for (Eigen::Index k = 0; k < columns; ++k) {
      const auto term = static_cast<std::size_t>(terms_[static_cast<std::size_t>(k)]);
      matrix.col(k) = state_.tables.column(state_.terms[term], first, rows).matrix();
    }
    const Eigen::Map<const Eigen::VectorXd> values(state_.samples.values.data() + first, rows);
    Eigen::VectorXd coefficients;
    if (fit) {
      Eigen::MatrixXd products = Eigen::MatrixXd::Zero(columns, columns);
      products.selfadjointView<Eigen::Lower>().rankUpdate(matrix.transpose());
      const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factors(products);
      if (factors.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
      coefficients = factors.solve(matrix.transpose() * values);
    } else {
      coefficients = dense_coefficients(state_, chosen());
    }
    return std::sqrt((values - matrix * coefficients).squaredNorm() / static_cast<double>(rows));
  }

  const State& state_;
  const AnnealingOptions& options_;
  SeededRandom random_;
  std::vector<int> terms_;  // those chosen come first
  std::vector<int> best_terms_;
  std::vector<std::size_t> places_;
  std::vector<std::pair<std::size_t, std::size_t>> exchanged_;
  double error_ = 0.0, best_ = 0.0;
};

Result<void> check_options(const State& state, const AnnealingOptions& options) {
  const int terms = static_cast<int>(state.terms.size());
  if (options.terms < 1 || options.terms >= terms)
    return failure(ErrorCode::InvalidArgument, fmt::format("annealing chooses 1 to {} terms", terms - 1));
  if (options.samples != 0 && (options.samples < options.terms || options.samples > state.tables.rows()))
    return failure(ErrorCode::InvalidArgument, "each step needs as many samples as terms, and no more than there are");
  if (options.iterations < 1 || !(options.power >= 0.0) || !(options.factor >= 0.0))
    return failure(ErrorCode::InvalidArgument, "annealing needs iterations, and a power and a factor of at least 0");
  return {};
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour::published {

Result<SparseFit> anneal(const DenseFit& dense, const AnnealingOptions& options, const Context& context) {
  const DenseFit::State& state = dense.state();
  if (const auto good = polynomial::check_options(state, options); !good) return tl::unexpected(good.error());
  const polynomial::Stopwatch watch;
  polynomial::Annealing annealing(state, options);
  SparseFit fit;
  const int stride = std::max(1, options.iterations / polynomial::kCurvePoints);
  for (int k = 0; k < options.iterations; ++k) {
    if (context.cancelled()) return interrupted();
    annealing.step(k);
    if (k % stride != 0 && k + 1 != options.iterations) continue;
    fit.curve.push_back({k + 1, watch.seconds(), annealing.error(), annealing.best()});
    if (context.progress) context.progress((k + 1.0) / options.iterations);
  }
  fit.polynomial = options.fit
                       ? polynomial::refined_subset(state, annealing.result())
                       : polynomial::subset_polynomial(state, annealing.result(),
                                                       polynomial::dense_coefficients(state, annealing.result()));
  fit.seconds = watch.seconds();
  fit.error = rms_error(fit.polynomial, state.samples);
  return fit;
}

}  // namespace contrejour::published
