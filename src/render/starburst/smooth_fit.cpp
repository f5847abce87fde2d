// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/smooth_fit.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxTerms = 45;  // those of the highest degree
constexpr double kPivotFloor = 1e-12;  // of the first pivot: directions that the points do not determine get weight 0

// Solves by Cholesky decomposition, in place: a symmetric n x n matrix and one right-hand side.
class Cholesky {
 public:
  Cholesky(std::vector<double> matrix, std::size_t n) : a_(std::move(matrix)), n_(n) {
    const double floor = kPivotFloor * a_[0];
    for (std::size_t j = 0; j < n_; ++j) {
      double pivot = at(j, j);
      for (std::size_t k = 0; k < j; ++k) pivot -= at(j, k) * at(j, k);
      at(j, j) = pivot > floor ? std::sqrt(pivot) : std::numeric_limits<double>::infinity();
      for (std::size_t i = j + 1; i < n_; ++i) {
        double sum = at(i, j);
        for (std::size_t k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
        at(i, j) = sum / at(j, j);
      }
    }
  }

  void solve(double* right) const {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = 0; k < i; ++k) right[i] -= at(i, k) * right[k];
      right[i] /= at(i, i);
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t k = i + 1; k < n_; ++k) right[i] -= at(k, i) * right[k];
      right[i] /= at(i, i);
    }
  }

 private:
  [[nodiscard]] double& at(std::size_t i, std::size_t j) { return a_[i * n_ + j]; }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return a_[i * n_ + j]; }

  std::vector<double> a_;
  std::size_t n_;
};

double half_of(double low, double high) { return high > low ? 0.5 * (high - low) : 1.0; }

}  // namespace

SmoothFit::SmoothFit(std::span<const Vec2> points, std::span<const double> values, int degree)
    : degree_(degree), functions_(values.size() / points.size()) {
  assert(degree >= 0 && degree <= kHighestDegree && values.size() == functions_ * points.size());
  const auto [left, right] =
      std::minmax_element(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; });
  const auto [low, high] = std::minmax_element(points.begin(), points.end(), [](Vec2 a, Vec2 b) { return a.y < b.y; });
  middle_ = {0.5 * (left->x + right->x), 0.5 * (low->y + high->y)};
  half_ = {half_of(left->x, right->x), half_of(low->y, high->y)};

  const std::size_t n = terms(degree_);
  std::vector<double> matrix(n * n);
  weights_.resize(functions_ * n);
  std::array<double, kMaxTerms> basis{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    basis_at(points[i], basis.data());
    for (std::size_t r = 0; r < n; ++r)
      for (std::size_t c = 0; c < n; ++c) matrix[r * n + c] += basis[r] * basis[c];
    for (std::size_t f = 0; f < functions_; ++f)
      for (std::size_t r = 0; r < n; ++r) weights_[f * n + r] += basis[r] * values[f * points.size() + i];
  }
  const Cholesky normal(std::move(matrix), n);
  for (std::size_t f = 0; f < functions_; ++f) normal.solve(weights_.data() + f * n);
}

void SmoothFit::basis_at(Vec2 point, double* basis) const {
  std::array<double, kHighestDegree + 1> tx, ty;
  tx[0] = ty[0] = 1.0;
  const double x = (point.x - middle_.x) / half_.x, y = (point.y - middle_.y) / half_.y;
  tx[1] = x;
  ty[1] = y;
  for (std::size_t k = 2; k <= static_cast<std::size_t>(degree_); ++k) {
    tx[k] = 2.0 * x * tx[k - 1] - tx[k - 2];
    ty[k] = 2.0 * y * ty[k - 1] - ty[k - 2];
  }
  for (std::size_t total = 0; total <= static_cast<std::size_t>(degree_); ++total)
    for (std::size_t k = 0; k <= total; ++k) *basis++ = tx[total - k] * ty[k];
}

void SmoothFit::evaluate(Vec2 point, double* values) const {
  std::array<double, kMaxTerms> basis;  // filled only as far as it is read: this runs for every sample near a border
  basis_at(point, basis.data());
  const std::size_t n = terms(degree_);
  for (std::size_t f = 0; f < functions_; ++f) {
    double sum = 0.0;
    for (std::size_t r = 0; r < n; ++r) sum += weights_[f * n + r] * basis[r];
    values[f] = sum;
  }
}

double SmoothFit::operator()(Vec2 point, std::size_t function) const {
  std::array<double, kMaxTerms> basis{};
  basis_at(point, basis.data());
  const std::size_t n = terms(degree_);
  double sum = 0.0;
  for (std::size_t r = 0; r < n; ++r) sum += weights_[function * n + r] * basis[r];
  return sum;
}

}  // namespace contrejour::inline internal
