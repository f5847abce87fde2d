// SPDX-License-Identifier: Apache-2.0
#include "polynomial/node_polynomials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace contrejour::inline internal::polynomial {
namespace {

// Chebyshev coefficients of the polynomial through values at Lobatto points.
std::vector<double> coefficients_of(std::span<const double> values) {
  const auto last = static_cast<int>(values.size()) - 1;
  std::vector<double> out(values.size(), 0.0);
  for (int l = 0; l <= last; ++l) {
    double sum = 0.0;
    for (int j = 0; j <= last; ++j) {
      const double end = j == 0 || j == last ? 0.5 : 1.0;
      sum += end * values[static_cast<std::size_t>(j)] * std::cos(std::numbers::pi * l * j / last);
    }
    out[static_cast<std::size_t>(l)] = (l == 0 || l == last ? 1.0 : 2.0) / last * sum;
  }
  return out;
}

// Terms whose degrees sum to one number, in the order in which for_each_term() visits them.
std::size_t terms_of_degree(int degree) {
  return static_cast<std::size_t>(term_count(degree) - term_count(degree - 1));
}
template <class Visit>
void for_each_of_degree(int degree, const Visit& visit) {
  for (int v = 0; v <= degree; ++v)
    for (int w = 0; w <= degree - v; ++w) visit(v, w, degree - v - w);
}

// The right-hand sides of all nodes and wavelengths.
GrowingLeastSquares::Right right_of(const GrowingSystem& system, int step, const std::vector<ValueOf>& coordinates) {
  std::vector<GrowingSystem::RightValue> values;
  for (const NodeRays& node : system.rays().nodes)
    for (std::size_t l = 0; l < node.tables.size(); l += static_cast<std::size_t>(step))
      values.emplace_back([&coordinates, &table = node.tables[l]](std::size_t ray, std::size_t coordinate) {
        return coordinates[coordinate](table, ray);
      });
  return system.right(values);
}

}  // namespace

ChebyshevSum assembled(int degree, std::size_t count, std::span<const std::vector<double>> solutions, std::size_t from,
                       double negligible) {
  std::vector<std::vector<double>> by_term;
  std::vector<double> values(solutions.size());
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t l = 0; l < solutions.size(); ++l) values[l] = solutions[l][from + t];
    by_term.push_back(coefficients_of(values));
  }
  std::size_t kept = solutions.size();
  for (double dropped = 0.0; kept > 1; --kept) {
    for (const auto& coefficients : by_term) dropped += std::abs(coefficients[kept - 1]);
    if (dropped > negligible) break;
  }
  ChebyshevSum sum{degree, static_cast<int>(kept), 1.0F, {}};
  double largest = 0.0;
  for (const auto& coefficients : by_term)
    for (const double c : coefficients) largest = std::max(largest, std::abs(c));
  if (!std::isfinite(largest)) return {};
  // The rounding of several hundred coefficients stays far below what is negligible, and float holds all multiples.
  const double step = std::exp2(std::floor(std::log2(std::max(negligible / 64.0, largest * 0x1p-23))));
  sum.step = static_cast<float>(step);
  for (std::size_t l = 0; l < kept; ++l)
    for (const auto& coefficients : by_term)
      sum.coefficients.push_back(static_cast<float>(step * std::round(coefficients[l] / step)));
  return sum;
}

Rows weighted_rows(int degree, bool of_vectors, std::span<const ZonePoint> points, std::span<const double> weights) {
  const auto count = static_cast<std::size_t>(term_count(degree));
  Rows rows;
  rows.columns = of_vectors ? 2 * count : count;
  rows.values.reserve(points.size() * rows.columns * (of_vectors ? 2 : 1));
  std::vector<double> terms(count);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const ZonePoint& point = points[k];
    term_values(degree, point, terms);
    const auto add = [&](double factor) {
      for (const double term : terms) rows.values.push_back(weights[k] * factor * term);
    };
    if (!of_vectors) {
      add(1.0);
      continue;
    }
    add(point.h), add(point.p.x);
    add(0.0), add(point.p.y);
  }
  return rows;
}

GrowingSystem::GrowingSystem(const FitRays& rays, const WeightedRays& weighted, std::span<const ZonePoint> points,
                             bool of_vectors)
    : rays_(rays), weighted_(weighted), points_(points), coordinates_(of_vectors ? 2 : 1),
      squares_(coordinates_ * weighted.used.size(), kRidge) {}

// Adds the terms whose degrees sum to one more than before.
void GrowingSystem::grow() {
  ++degree_;
  const std::size_t padded = squares_.padded_rows(), terms = terms_of_degree(degree_);
  std::vector<double> columns(coordinates_ * terms * padded, 0.0);
  std::array<double, kMaxDegree + 1> u{}, v{}, w{};
  for (std::size_t k = 0; k < weighted_.used.size(); ++k) {
    const ZonePoint& point = points_[weighted_.used[k]];
    chebyshev_values(point.u, u);
    chebyshev_values(point.v, v);
    chebyshev_values(point.w, w);
    std::size_t term = 0;
    for_each_of_degree(degree_, [&](int kv, int kw, int ku) {
      const double value = weighted_.weight[k] * v[static_cast<std::size_t>(kv)] * w[static_cast<std::size_t>(kw)] *
                           u[static_cast<std::size_t>(ku)];
      double* const at = columns.data() + term * padded + coordinates_ * k;
      if (coordinates_ == 1) {
        *at = value;
      } else {
        *at = point.h * value;
        double* const along_pupil = at + terms * padded;
        along_pupil[0] = point.p.x * value;
        along_pupil[1] = point.p.y * value;
      }
      ++term;
    });
  }
  squares_.add(std::move(columns));
}

std::vector<std::vector<double>> GrowingSystem::solve(int degree, GrowingLeastSquares::Right& right) {
  while (degree_ < degree) grow();
  const auto count = static_cast<std::size_t>(term_count(degree));
  std::vector<std::vector<double>> solutions = squares_.solve(right, coordinates_ * count);
  for (std::vector<double>& solution : solutions) {
    std::vector<double> ordered(solution.size());
    std::array<std::size_t, kMaxDegree + 1> seen{};  // by the sum of the degrees
    std::size_t at = 0;
    for_each_term(degree, [&](int v, int w, int u) {
      const int sum = v + w + u;
      const std::size_t from =
          coordinates_ * static_cast<std::size_t>(term_count(sum - 1)) + seen[static_cast<std::size_t>(sum)]++;
      ordered[at] = solution[from];
      if (coordinates_ == 2) ordered[count + at] = solution[from + terms_of_degree(sum)];
      ++at;
    });
    solution = std::move(ordered);
  }
  return solutions;
}

GrowingLeastSquares::Right GrowingSystem::right(std::span<const RightValue> values) const {
  const std::size_t padded = squares_.padded_rows();
  std::vector<double> columns(values.size() * padded, 0.0);
  for (std::size_t column = 0; column < values.size(); ++column)
    for (std::size_t k = 0; k < weighted_.used.size(); ++k)
      for (std::size_t c = 0; c < coordinates_; ++c)
        columns[column * padded + coordinates_ * k + c] = weighted_.weight[k] * values[column](weighted_.used[k], c);
  return GrowingLeastSquares::Right(std::move(columns));
}

bool Systems::has_enough_rays(int degree) const {
  return static_cast<double>(weighted_.used.size()) >= kSamplesPerUnknown * term_count(degree);
}

OutputFit::OutputFit(GrowingSystem& system, int step, const std::vector<ValueOf>& coordinates, double negligible)
    : system_(system), negligible_(negligible), right_(right_of(system, step, coordinates)) {}

NodeSums OutputFit::sums(int degree) {
  NodeSums sums;
  for_each_node(degree, [&](std::span<const std::vector<double>> solutions, std::size_t count) {
    sums.push_back(assembled(degree, count, solutions, 0, negligible_));
  });
  return sums;
}

NodeVectors OutputFit::vectors(int degree) {
  NodeVectors vectors;
  for_each_node(degree, [&](std::span<const std::vector<double>> solutions, std::size_t count) {
    vectors.push_back(
        {assembled(degree, count, solutions, 0, negligible_), assembled(degree, count, solutions, count, negligible_)});
  });
  return vectors;
}

template <class Add>
void OutputFit::for_each_node(int degree, const Add& add) {
  const std::vector<std::vector<double>> solutions = system_.solve(degree, right_);
  const std::size_t nodes = system_.rays().nodes.size(), wavelengths = solutions.size() / nodes;
  for (std::size_t n = 0; n < nodes; ++n)
    add(std::span(solutions).subspan(n * wavelengths, wavelengths), static_cast<std::size_t>(term_count(degree)));
}

}  // namespace contrejour::inline internal::polynomial
