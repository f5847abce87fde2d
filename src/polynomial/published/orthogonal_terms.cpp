// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/orthogonal_terms.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {
namespace {

// Below this fraction of a term's sum of squares, what is left of it is rounding.
constexpr double kDependent = 1e-10;

}  // namespace

OrthogonalTerms::OrthogonalTerms(const published::DenseFit::State& state)
    : state_(state), squares_(state.products.diagonal()), right_(state.right), left_(state.squares) {}

void OrthogonalTerms::choose(int term) {
  const double norm = std::sqrt(squares_[term]);
  Eigen::VectorXd products = state_.products.col(term);
  for (const Eigen::VectorXd& other : chosen_) products -= other[term] * other;
  products /= norm;
  const double along = right_[term] / norm;
  squares_ -= products.cwiseAbs2();
  right_ -= along * products;
  left_ -= along * along;
  squares_[term] = 0.0;
  chosen_.push_back(std::move(products));
}

double OrthogonalTerms::gain(Eigen::Index term) const {
  const double square = squares_[term];
  return square > kDependent * state_.products(term, term) ? right_[term] * right_[term] / square : 0.0;
}

int OrthogonalTerms::best() const {
  int best = -1;
  double largest = 0.0;
  for (Eigen::Index k = 0; k < squares_.size(); ++k) {
    const double gained = gain(k);
    if (gained <= largest) continue;
    largest = gained;
    best = static_cast<int>(k);
  }
  return best;
}

double OrthogonalTerms::error() const {
  return std::sqrt(std::max(left_, 0.0) / static_cast<double>(state_.samples.values.size()));
}

double OrthogonalTerms::error_with(int term) const {
  return std::sqrt(std::max(left_ - gain(term), 0.0) / static_cast<double>(state_.samples.values.size()));
}

}  // namespace contrejour::inline internal::polynomial
